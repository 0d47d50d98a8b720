// Dark and light: as the system says until the user says otherwise.
const media = matchMedia('(prefers-color-scheme: light)');
const listeners = [];
let chosen = null;

export const reducedMotion = matchMedia('(prefers-reduced-motion: reduce)');

export const isLight = () => (chosen ?? (media.matches ? 'light' : 'dark')) === 'light';

function apply() {
  document.documentElement.dataset.theme = isLight() ? 'light' : 'dark';
  listeners.forEach((listener) => listener(isLight()));
}

export function toggleTheme() {
  chosen = isLight() ? 'dark' : 'light';
  apply();
}

/// Called at once and at every change.
export function onTheme(listener) {
  listeners.push(listener);
  listener(isLight());
}

/// A colour of style.css.
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

media.addEventListener('change', apply);
apply();
