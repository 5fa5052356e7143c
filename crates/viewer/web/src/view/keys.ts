/** Keys of the page. They do nothing while text is typed or a dialog is open. */

export type Keys = Record<string, (event: KeyboardEvent) => void>;

/** Calls what stands for a key: its name as `KeyboardEvent.key` has it, with "Shift+" before arrows. */
export function listen(keys: Keys): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || busy(event)) return;
    const action = keys[nameOf(event)];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

function nameOf(event: KeyboardEvent): string {
  if (event.key.length === 1) return event.key === ' ' ? 'Space' : event.key.toLowerCase();
  return `${event.shiftKey ? 'Shift+' : ''}${event.key}`;
}

/** Whether what has the focus wants the key for itself. */
function busy(event: KeyboardEvent): boolean {
  if (document.querySelector('dialog[open]')) return true;
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (target?.closest('input:not([type=checkbox]), textarea, select')) return true;
  const pressed = event.key === ' ' || event.key === 'Enter';
  return pressed && target?.closest('button, a, summary') !== null && target !== null;
}
