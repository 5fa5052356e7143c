/** The controls on the stage: from where to look, and what to show beside the bodies. */

import { h, setAttribute } from '../dom/h';
import { type Icon, icon } from '../dom/icons';
import type { Preset } from '../stage';

/** What can be shown beside the bodies. */
export const SHOWN = ['names', 'axes', 'trails', 'com', 'markers'] as const;
export type Shown = (typeof SHOWN)[number];

export interface ToolActions {
  preset(preset: Preset): void;
  show(what: Shown): void;
  plots(): void;
  screenshot(): void;
  share(): void;
  theme(): void;
  help(): void;
}

export interface ToolState {
  show: Record<Shown, boolean>;
  plots: boolean;
}

/** Fills the bar on the stage. What it gives back shows the state. */
export function tools(element: HTMLElement, actions: ToolActions): (state: ToolState) => void {
  const presets = PRESETS.map(([preset, label, key]) =>
    h('button', { type: 'button', title: `${label} (${key})`, onclick: () => actions.preset(preset) }, label),
  );
  const toggles = SHOWN.map((what) => {
    const [label, key] = LABELS[what];
    const onclick = (): void => actions.show(what);
    return h('button', { type: 'button', title: `${label} (${key})`, 'aria-pressed': 'false', onclick }, label);
  });
  const plots = h(
    'button',
    { type: 'button', title: 'Plots (g)', 'aria-pressed': 'false', onclick: actions.plots },
    icon('plots'),
    'Plots',
  );
  element.append(
    h('div', { class: 'group', role: 'group', 'aria-label': 'Camera' }, ...presets),
    h('div', { class: 'group', role: 'group', 'aria-label': 'Show' }, ...toggles),
    h('div', { class: 'group', role: 'group', 'aria-label': 'Panels' }, plots),
  );
  return (state) => {
    toggles.forEach((button, place) => setAttribute(button, 'aria-pressed', String(state.show[SHOWN[place]!])));
    setAttribute(plots, 'aria-pressed', String(state.plots));
  };
}

/** Fills the bar at the top of the page. */
export function pageActions(element: HTMLElement, actions: ToolActions): void {
  const button = (name: Icon, label: string, key: string, onclick: () => void): HTMLElement =>
    h(
      'button',
      { type: 'button', class: 'icon', 'aria-label': label, title: `${label} (${key})`, onclick },
      icon(name),
    );
  element.append(
    button('camera', 'Save a picture', 'p', actions.screenshot),
    button('link', 'Copy the address of this view', 's', actions.share),
    button('theme', 'Light or dark', 'l', actions.theme),
    button('help', 'Keys and help', '?', actions.help),
  );
}

const PRESETS: [Preset, string, string][] = [
  ['free', 'Free', '0'],
  ['front', 'Front', '1'],
  ['side', 'Side', '2'],
  ['top', 'Top', '3'],
];

const LABELS: Record<Shown, [string, string]> = {
  names: ['Names', 'n'],
  axes: ['Axes', 'a'],
  trails: ['Trails', 't'],
  com: ['Centre of mass', 'c'],
  markers: ['Markers', 'm'],
};
