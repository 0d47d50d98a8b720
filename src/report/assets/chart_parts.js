// What all charts share: scales, axes, curves, views from above, tips. Plain SVG.
const finite = Number.isFinite;
const esc = (s) => String(s).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
const show = (v, digits) => (finite(v) ? v.toFixed(digits) : '–');
const px = (v) => v.toFixed(1);
const range = (...columns) => {
  let low = Infinity, high = -Infinity;
  for (const column of columns) for (const v of column) if (finite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  return low <= high ? [low, high] : [0, 1];
};

// Round steps for an axis: 1, 2 or 5 times a power of ten.
const stepOf = (span, count) => {
  const raw = span / Math.max(1, count), power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((m) => m * power >= raw * 0.999);
};
// At least three where there is room: one alone shows no scale.
const ticks = (low, high, count, least = 0) => {
  const span = high - low || 1, inside = (step) => Math.floor(high / step + 1e-6) - Math.ceil(low / step - 1e-6) + 1;
  const coarse = stepOf(span, count), step = Math.max(least, inside(coarse) < 3 ? stepOf(span, 2 * count) : coarse), values = [];
  for (let k = Math.ceil(low / step - 1e-6); k * step <= high + step * 1e-6; ++k) values.push(k * step);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-6));
  return values.map((v) => ({ v, text: (Math.abs(v) < step / 2 ? 0 : v).toFixed(digits) }));
};
const path = (xs, ys) => {
  let d = '', open = false;
  for (let i = 0; i < xs.length; ++i) {
    if (!finite(ys[i])) { open = false; continue; }
    d += `${open ? 'L' : 'M'}${px(xs[i])} ${px(ys[i])}`;
    open = true;
  }
  return d;
};
// Keeps the lowest and the highest value of every pixel column, so that long runs stay light and no peak is lost.
const thinned = (x, y, width) => {
  const n = x.length, bins = Math.ceil(width);
  if (n <= 3 * bins) return [x, y];
  const xs = [], ys = [];
  for (let b = 0; b < bins; ++b) {
    const from = Math.floor(b * n / bins), to = Math.floor((b + 1) * n / bins);
    let low = -1, high = -1;
    for (let i = from; i < to; ++i) {
      if (!finite(y[i])) continue;
      if (low < 0 || y[i] < y[low]) low = i;
      if (high < 0 || y[i] > y[high]) high = i;
    }
    for (const i of low < high ? [low, high] : [high, low]) if (i >= 0) { xs.push(x[i]); ys.push(y[i]); }
  }
  return [xs, ys];
};
const distances = (p) => {
  const d = new Array(p.x.length).fill(0);
  for (let i = 1; i < d.length; ++i) {
    d[i] = d[i - 1] + Math.hypot(p.x[i] - p.x[i - 1], p.y[i] - p.y[i - 1], p.z[i] - p.z[i - 1]);
  }
  return d;
};
const nearest = (sorted, v) => {
  let low = 0, high = sorted.length - 1;
  while (high - low > 1) { const mid = (low + high) >> 1; if (sorted[mid] < v) low = mid; else high = mid; }
  return v - sorted[low] <= sorted[high] - v ? low : high;
};
const legend = (entries) => '<ul class="legend">' + entries.map((e) =>
  `<li>${e.color ? `<i class="${e.kind || ''}" style="${e.kind === 'dash' ? 'border-color' : 'background'}:${e.color}"></i>` : ''}` +
  `<span>${esc(e.name)}${e.value ? ` <b>${esc(e.value)}</b>` : ''}</span></li>`).join('') + '</ul>';

// Tooltip beside (x, y) of `host`, kept inside it.
const tip = (host) => {
  const box = document.createElement('div');
  box.className = 'tip';
  box.hidden = true;
  host.append(box);
  return {
    hide: () => { box.hidden = true; },
    at: (x, y, lines) => {
      box.innerHTML = lines.map(esc).join('<br>');
      box.hidden = false;
      const left = x + 14 + box.offsetWidth > host.clientWidth ? x - 14 - box.offsetWidth : x + 14;
      box.style.left = `${Math.max(0, left)}px`;
      box.style.top = `${Math.max(0, y - box.offsetHeight - 8)}px`;
    },
  };
};
// Calls move(x, y) in the coordinates of the SVG while the pointer is over it, leave() afterwards. With the focus, the
// arrow keys move, Escape leaves.
const track = (svg, move, leave) => {
  let at = null;
  const handle = (e) => { const r = svg.getBoundingClientRect(); at = [e.clientX - r.left, e.clientY - r.top]; move(...at); };
  svg.setAttribute('tabindex', '0');
  svg.addEventListener('keydown', (e) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
    if (e.key === 'Escape') { at = null; leave(); }
    if (!step) return;
    e.preventDefault();
    const w = svg.clientWidth, h = svg.clientHeight, size = Math.max(w / 60, 4);
    const [x, y] = at || [w / 2, h / 2];
    at = [Math.min(w - 1, Math.max(1, x + size * step[0])), Math.min(h - 1, Math.max(1, y + size * step[1]))];
    move(...at);
  });
  svg.addEventListener('blur', () => { at = null; leave(); });
  svg.addEventListener('pointermove', handle);
  svg.addEventListener('pointerdown', handle);
  svg.addEventListener('pointerleave', leave);
};

// Axes with a grid. Returns scales and the opening of the SVG.
const axes = (host, o) => {
  const width = host.clientWidth, height = o.height;
  const m = { left: 50, right: 12, top: o.ylabel ? 22 : 8, bottom: o.xlabel ? 36 : 20 };
  let [x0, x1] = o.xrange, [y0, y1] = o.yrange;
  if (x1 - x0 < 1e-9) { const pad = Math.abs(x0) * 0.2 || 0.5; x0 -= pad; x1 += pad; }
  if (y1 - y0 < 1e-9) { const pad = Math.abs(y0) * 0.1 || 0.5; y0 = o.zero && y0 === 0 ? 0 : y0 - pad; y1 += pad; }
  const w = width - m.left - m.right, h = height - m.top - m.bottom;
  const sx = (v) => m.left + (v - x0) / (x1 - x0) * w, sy = (v) => m.top + h - (v - y0) / (y1 - y0) * h;
  let svg = '';
  for (const t of ticks(y0, y1, Math.max(2, h / 38), o.counts ? 1 : 0)) {
    svg += `<line class="gridline" x1="${m.left}" x2="${width - m.right}" y1="${px(sy(t.v))}" y2="${px(sy(t.v))}"/>` +
      `<text x="${m.left - 7}" y="${px(sy(t.v) + 4)}" text-anchor="end">${t.text}</text>`;
  }
  for (const t of ticks(x0, x1, Math.max(2, w / 68), o.whole ? 1 : 0)) {
    svg += `<line class="gridline" x1="${px(sx(t.v))}" x2="${px(sx(t.v))}" y1="${m.top}" y2="${m.top + h}"/>` +
      `<text x="${px(sx(t.v))}" y="${m.top + h + 15}" text-anchor="middle">${t.text}</text>`;
  }
  svg += `<line class="axis" x1="${m.left}" x2="${width - m.right}" y1="${m.top + h}" y2="${m.top + h}"/>`;
  if (o.xlabel) svg += `<text x="${px(m.left + w / 2)}" y="${height - 4}" text-anchor="middle">${esc(o.xlabel)}</text>`;
  if (o.ylabel) svg += `<text x="${m.left}" y="12">${esc(o.ylabel)}</text>`;
  return { svg, sx, sy, w, h, m, width, height, x0, x1, y0, y1 };
};
const mount = (host, head, svg, width, height, night) => {
  host.innerHTML = `${head}<div class="${night ? 'night' : ''}" style="position:relative"><svg role="img" width="${width}" ` +
    `height="${height}" viewBox="0 0 ${width} ${height}">${svg}</svg></div>`;
  const box = host.lastElementChild;
  const svgElement = box.firstElementChild, panel = host.closest('.panel');
  svgElement.setAttribute('aria-label', (panel && panel.querySelector('h3') ? panel.querySelector('h3').textContent : 'chart'));
  return { box, svg: svgElement, tip: tip(box) };
};

// Curves over one axis. o: {height, x, xlabel, ylabel, series: [{name, y, color, digits, unit, truth, x, dash, width, dots}],
// levels, zero, ymax, linked, whole: x counts, counts: y does}. A series without x of its own has that of the chart.
const curves = (run, host, o) => {
  let [y0, y1] = range(...o.series.map((s) => s.y));
  if (o.zero) y0 = Math.min(0, y0);
  if (finite(o.ymax)) y1 = Math.min(y1, o.ymax);
  const pad = (y1 - y0) * 0.06;
  const a = axes(host, {
    height: o.height, xlabel: o.xlabel, ylabel: o.ylabel, zero: o.zero, whole: o.whole, counts: o.counts, xrange: range(o.x, ...o.series.map((s) => s.x || [])),
    yrange: [o.zero && y0 === 0 ? 0 : y0 - pad, y1 + pad],
  });
  let svg = a.svg + (o.under ? o.under(a) : '');
  for (const level of o.levels || []) {
    if (level.y < a.y0 || level.y > a.y1) continue;
    svg += `<line class="level" stroke="${level.color}" stroke-dasharray="${level.dash}" x1="${a.m.left}" ` +
      `x2="${a.width - a.m.right}" y1="${px(a.sy(level.y))}" y2="${px(a.sy(level.y))}"/>`;
  }
  for (const s of o.series) {
    const [x, y] = thinned(s.x || o.x, s.y, a.w);
    const ys = y.map((v) => (finite(v) ? a.sy(Math.min(v, a.y1)) : v));
    svg += `<path class="${s.truth ? 'truthline' : 'curve'}" style="stroke:${s.color}${s.width ? `;stroke-width:${s.width}` : ''}" ` +
      `${s.dash ? `stroke-dasharray="${s.dash}" ` : ''}d="${path(x.map(a.sx), ys)}"/>`;
    if (s.dots) x.forEach((v, i) => { if (finite(ys[i])) svg += `<circle cx="${px(a.sx(v))}" cy="${px(ys[i])}" r="${s.dots}" fill="${s.color}"/>`; });
    else if (x.length === 1 && finite(ys[0])) svg += `<circle cx="${px(a.sx(x[0]))}" cy="${px(ys[0])}" r="3.5" fill="${s.color}"/>`;
  }
  svg += o.over ? o.over(a) : '';
  svg += `<line class="cursor" y1="${a.m.top}" y2="${a.m.top + a.h}" visibility="hidden"/>`;
  const view = mount(host, o.legend === undefined ? legend(o.series) : o.legend, svg, a.width, a.height);
  const line = view.svg.querySelector('.cursor');
  const place = (i) => {
    line.setAttribute('visibility', i === null ? 'hidden' : 'visible');
    if (i !== null) for (const end of ['x1', 'x2']) line.setAttribute(end, px(a.sx(o.x[i])));
  };
  if (o.linked) run.listeners.push(place);
  track(view.svg, (x, y) => {
    const at = a.x0 + (x - a.m.left) / a.w * (a.x1 - a.x0), i = nearest(o.x, at);
    const lines = o.series.filter((s) => s.y.length).map((s) => {
      const k = s.x ? nearest(s.x, o.x[i]) : i;
      return `${s.name}: ${s.text ? s.text(k) : `${show(s.y[k], s.digits)} ${s.unit}`}`;
    });
    if (o.linked) run.point(i); else place(i);
    view.tip.at(a.sx(o.x[i]), y, [o.xname(i), ...lines]);
  }, () => { view.tip.hide(); if (o.linked) run.point(null); else place(null); });
};

// A view with equal axes of the area [left, right] × [bottom, top]. `inner` draws with the scales it is given. Above it
// o.truth and o.paths: [{p, color, dash}]; the pointer finds the nearest pose k of path n: o.point(n, k) when it does and
// o.point(null) when it leaves, o.describe(n, k) for the tip. o.follow(listener) says which pose of the first path to mark.
const plane = (host, o) => {
  const width = host.clientWidth;
  const spanX = Math.max(o.right - o.left, 2), spanY = Math.max(o.top - o.bottom, 2);
  const inset = o.inset, most = Math.min(o.height, Math.max(260, width * 1.15));
  const scale = Math.min((width - 2 * inset) / spanX, (most - 2 * inset) / spanY);
  const height = o.fill ? most : Math.min(most, Math.max(o.least || 200, spanY * scale + 2 * inset));
  const sx = (v) => width / 2 + (v - (o.left + o.right) / 2) * scale;
  const sy = (v) => height / 2 - (v - (o.bottom + o.top) / 2) * scale;
  const a = { sx, sy, scale, width, height };
  let svg = o.inner(a);
  const curve = (q) => path(q.x.map(sx), q.y.map(sy));
  if (o.truth && o.truth.x.length) svg += `<path class="truthline" style="stroke-width:${o.night ? 4 : 5.5}${o.truthColor ? `;stroke:${o.truthColor}` : ''}" d="${curve(o.truth)}"/>`;
  const ring = o.night ? '#0b1017' : 'var(--panel)';
  for (const { p, color, dash, width: line } of o.paths) {
    if (o.night) svg += `<path fill="none" stroke="#000" stroke-opacity=".6" stroke-width="4" d="${curve(p)}"/>`;
    svg += `<path class="estimateline" style="stroke:${color}${line ? `;stroke-width:${line}` : ''}" ${dash ? `stroke-dasharray="${dash}" ` : ''}d="${curve(p)}"/>`;
  }
  for (const { p, color } of o.paths) {
    const last = p.x.length - 1;
    svg += `<rect x="${px(sx(p.x[last]) - 5)}" y="${px(sy(p.y[last]) - 5)}" width="10" height="10" rx="2" fill="${o.paths.length > 1 ? color : 'var(--bad)'}" stroke="${ring}" stroke-width="1.5"/>`;
  }
  if (o.paths.length) svg += `<circle cx="${px(sx(o.paths[0].p.x[0]))}" cy="${px(sy(o.paths[0].p.y[0]))}" r="5.5" fill="var(--ok)" stroke="${ring}" stroke-width="1.5"/>`;
  const bar = stepOf(width / scale * 0.22, 1) > width / scale * 0.4 ? stepOf(width / scale * 0.1, 1) : stepOf(width / scale * 0.2, 1);
  // In the left corner, unless the trajectory passes there.
  const under = ({ p }) => p.x.some((x, i) => sx(x) < 28 + bar * scale && sy(p.y[i]) > height - 44);
  const from = o.paths.some(under) ? width - 14 - bar * scale : 14;
  svg += `<path class="scalebar" d="M${px(from)} ${height - 20}v6h${px(bar * scale)}v-6"/>` +
    `<text class="strong" x="${px(from + bar * scale / 2)}" y="${height - 22}" text-anchor="middle">${bar >= 1 ? bar : bar.toFixed(2)} m</text>`;
  svg += '<circle class="dot" r="5" visibility="hidden"/>';
  const view = mount(host, o.legend, svg, width, height, o.night);
  const dot = view.svg.querySelector('.dot');
  const place = (n, k) => {
    dot.setAttribute('visibility', n === null ? 'hidden' : 'visible');
    if (n === null) return;
    dot.setAttribute('cx', px(sx(o.paths[n].p.x[k])));
    dot.setAttribute('cy', px(sy(o.paths[n].p.y[k])));
  };
  if (o.follow) o.follow(place);
  track(view.svg, (x, y) => {
    let n = -1, k = 0, least = Infinity;
    o.paths.forEach(({ p }, path) => {
      for (let i = 0; i < p.x.length; ++i) {
        const d = (sx(p.x[i]) - x) ** 2 + (sy(p.y[i]) - y) ** 2;
        if (d < least) { least = d; n = path; k = i; }
      }
    });
    if (n < 0) return;
    if (o.point) o.point(n, k); else place(n, k);
    view.tip.at(sx(o.paths[n].p.x[k]), sy(o.paths[n].p.y[k]), o.describe(n, k));
  }, () => { view.tip.hide(); if (o.point) o.point(null); else place(null); });
};
// Grid of round coordinates for plane(): the labels of x at the top, of y at the right.
const coordinates = (left, right, bottom, top) => (a) => {
  const step = stepOf(a.width / a.scale, Math.max(3, a.width / 90)), half = [a.width / 2 / a.scale, a.height / 2 / a.scale];
  const centre = [(left + right) / 2, (bottom + top) / 2], digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-6));
  const text = (v) => (Math.abs(v) < step / 2 ? 0 : v).toFixed(digits);
  let svg = '';
  for (let k = Math.ceil((centre[0] - half[0]) / step); k * step <= centre[0] + half[0]; ++k) {
    const x = a.sx(k * step);
    svg += `<line class="gridline" x1="${px(x)}" x2="${px(x)}" y1="0" y2="${a.height}"/>`;
    if (x > 16 && x < a.width - 20) svg += `<text x="${px(x)}" y="12" text-anchor="middle">${text(k * step)}</text>`;
  }
  for (let k = Math.ceil((centre[1] - half[1]) / step); k * step <= centre[1] + half[1]; ++k) {
    const y = a.sy(k * step);
    if (y < 18) continue;  // the labels of x are there
    svg += `<line class="gridline" x1="0" x2="${a.width}" y1="${px(y)}" y2="${px(y)}"/>`;
    if (y > 24 && y < a.height - 40) svg += `<text x="${a.width - 4}" y="${px(y - 3)}" text-anchor="end">${text(k * step)}</text>`;
  }
  return svg;
};
