import { describe, expect, it } from 'vitest';
import text from './tokens.css?raw';

describe.each(['dark', 'light'])('in %s', (theme) => {
  const tokens = tokensOf(theme);
  const ratio = (front: string, back: string) => contrast(tokens[front]!, tokens[back]!);

  it('text is read on every ground that it stands on (AA: 4.5)', () => {
    for (const front of ['ink', 'muted', 'live', 'stale', 'lost', 'accent']) {
      for (const back of ['surface', 'ground', 'raised']) {
        expect(ratio(front, back), `${front} on ${back}`).toBeGreaterThanOrEqual(4.5);
      }
    }
    expect(ratio('surface', 'lost')).toBeGreaterThanOrEqual(4.5);
  });

  it('lines of plots, edges of fields and what lies on the timeline are told apart (AA: 3)', () => {
    const lines = Object.keys(tokens).filter((name) => name.startsWith('trace-'));
    expect(lines).toHaveLength(8);
    for (const front of [...lines, 'line-strong']) {
      expect(ratio(front, 'surface'), front).toBeGreaterThanOrEqual(3);
    }
  });
});

/** The colours of a theme that are written as #rrggbb. */
function tokensOf(theme: string): Record<string, string> {
  const block = new RegExp(`\\[data-theme='${theme}'\\] \\{([^}]*)\\}`).exec(text)![1]!;
  return Object.fromEntries(
    [...block.matchAll(/--([\w-]+): (#[0-9a-f]{6});/g)].map(([, name, color]) => [name, color]),
  );
}

/** As WCAG 2 has it: from 1 to 21. */
function contrast(a: string, b: string): number {
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x) as [number, number];
  return (light + 0.05) / (dark + 0.05);
}

function luminance(color: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const part = parseInt(color.slice(at, at + 2), 16) / 255;
    return part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
