// The keyboard, for everything that the pointer can do.
const COLOURS = ['height', 'intensity', 'residual', 'time'];

export function listen(view) {
  const step = (by) => {
    view.run.play(false);
    view.run.show(view.run.shown + by);
  };
  const keys = {
    ' ': () => view.run.play(!view.run.playing && !(view.run.newest && !view.run.progress.finished)),
    ArrowLeft: (event) => step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
    Home: () => view.run.show(0),
    End: () => view.run.show(Infinity, true),
    '[': () => view.speed(-1),
    ']': () => view.speed(1),
    f: () => view.choose('camera', 'follow'),
    o: () => view.choose('camera', 'orbit'),
    t: () => view.choose('camera', 'top'),
    a: () => view.stage.nudge(-0.1, 0, 1),
    d: () => view.stage.nudge(0.1, 0, 1),
    w: () => view.stage.nudge(0, 0.06, 1),
    s: () => view.stage.nudge(0, -0.06, 1),
    '+': () => view.stage.nudge(0, 0, 0.87),
    '-': () => view.stage.nudge(0, 0, 1.15),
    m: () => view.toggle('map'),
    p: () => view.toggle('sweep'),
    g: () => view.toggle('truth'),
    e: () => ['covariance', 'evidence'].forEach((name) => view.toggle(name)),
    l: () => view.theme(),
    '?': () => document.getElementById('keys').showModal(),
  };
  COLOURS.forEach((name, i) => { keys[i + 1] = () => view.choose('colour', name); });
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    const own = event.target.closest?.('button, select, input, summary');
    // What has the focus keeps the keys that it uses itself.
    if (own && (own.type === 'range' ? event.key.startsWith('Arrow') || ['Home', 'End'].includes(event.key)
      : [' ', 'Enter'].includes(event.key) || own.tagName === 'SELECT')) return;
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}
