/** Dark or light: as the system has it, until the person at the page chooses. */

export type Theme = 'dark' | 'light';

/** Sets the theme that was chosen before, or the system's, and says which. */
export function initialTheme(): Theme {
  const chosen = remembered();
  return chosen ?? (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
}

/** Shows a theme, and keeps it for the next time when it was chosen. */
export function showTheme(theme: Theme, chosen: boolean): void {
  document.documentElement.dataset.theme = theme;
  if (!chosen) return;
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // A browser that keeps nothing: the system's theme the next time.
  }
}

function remembered(): Theme | null {
  try {
    const theme = localStorage.getItem(KEY);
    return theme === 'dark' || theme === 'light' ? theme : null;
  } catch {
    return null;
  }
}

const KEY = 'posewire-theme';
