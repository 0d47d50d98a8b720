// Draws the charts of every run from the JSON beside it. Plain SVG, redrawn when the width changes.
(() => {
  'use strict';
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
  const ticks = (low, high, count) => {
    const step = stepOf(high - low || 1, count), values = [];
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
  // Calls move(x, y) in the coordinates of the SVG while the pointer is over it, leave() afterwards.
  const track = (svg, move, leave) => {
    const handle = (e) => { const r = svg.getBoundingClientRect(); move(e.clientX - r.left, e.clientY - r.top); };
    svg.addEventListener('pointermove', handle);
    svg.addEventListener('pointerdown', handle);
    svg.addEventListener('pointerleave', leave);
  };

  // Axes with a grid. Returns scales and the opening of the SVG.
  const axes = (host, o) => {
    const width = host.clientWidth, height = o.height;
    const m = { left: 50, right: 12, top: 8, bottom: o.xlabel ? 36 : 20 };
    let [x0, x1] = o.xrange, [y0, y1] = o.yrange;
    if (x1 - x0 < 1e-9) { x0 -= 0.5; x1 += 0.5; }
    if (y1 - y0 < 1e-9) { const pad = Math.abs(y0) * 0.1 || 0.5; y0 = o.zero && y0 === 0 ? 0 : y0 - pad; y1 += pad; }
    const w = width - m.left - m.right, h = height - m.top - m.bottom;
    const sx = (v) => m.left + (v - x0) / (x1 - x0) * w, sy = (v) => m.top + h - (v - y0) / (y1 - y0) * h;
    let svg = '';
    for (const t of ticks(y0, y1, Math.max(2, h / 38))) {
      svg += `<line class="gridline" x1="${m.left}" x2="${width - m.right}" y1="${px(sy(t.v))}" y2="${px(sy(t.v))}"/>` +
        `<text x="${m.left - 7}" y="${px(sy(t.v) + 4)}" text-anchor="end">${t.text}</text>`;
    }
    for (const t of ticks(x0, x1, Math.max(2, w / 68))) {
      svg += `<line class="gridline" x1="${px(sx(t.v))}" x2="${px(sx(t.v))}" y1="${m.top}" y2="${m.top + h}"/>` +
        `<text x="${px(sx(t.v))}" y="${m.top + h + 15}" text-anchor="middle">${t.text}</text>`;
    }
    svg += `<line class="axis" x1="${m.left}" x2="${width - m.right}" y1="${m.top + h}" y2="${m.top + h}"/>`;
    if (o.xlabel) svg += `<text x="${px(m.left + w / 2)}" y="${height - 4}" text-anchor="middle">${esc(o.xlabel)}</text>`;
    return { svg, sx, sy, w, h, m, width, height, x0, x1, y0, y1 };
  };
  const mount = (host, head, svg, width, height, night) => {
    host.innerHTML = `${head}<div class="${night ? 'night' : ''}" style="position:relative"><svg role="img" width="${width}" ` +
      `height="${height}" viewBox="0 0 ${width} ${height}">${svg}</svg></div>`;
    const box = host.lastElementChild;
    return { box, svg: box.firstElementChild, tip: tip(box) };
  };

  // Curves over one axis. o: {height, x, xlabel, series: [{name, y, color, digits, unit, truth}], levels, zero, ymax, linked}
  const curves = (run, host, o) => {
    let [y0, y1] = range(...o.series.map((s) => s.y));
    if (o.zero) y0 = Math.min(0, y0);
    if (finite(o.ymax)) y1 = Math.min(y1, o.ymax);
    const pad = (y1 - y0) * 0.06;
    const a = axes(host, {
      height: o.height, xlabel: o.xlabel, zero: o.zero, xrange: range(o.x, ...o.series.map((s) => s.x || [])),
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
      svg += `<path class="${s.truth ? 'truthline' : 'curve'}" style="stroke:${s.color}" d="${path(x.map(a.sx), ys)}"/>`;
      if (x.length === 1 && finite(ys[0])) svg += `<circle cx="${px(a.sx(x[0]))}" cy="${px(ys[0])}" r="3.5" fill="${s.color}"/>`;
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
      const i = nearest(o.x, a.x0 + (x - a.m.left) / a.w * (a.x1 - a.x0));
      const lines = o.series.filter((s) => i < s.y.length && !s.x).map((s) => `${s.name}: ${show(s.y[i], s.digits)} ${s.unit}`);
      if (o.linked) run.point(i); else place(i);
      view.tip.at(a.sx(o.x[i]), y, [o.xname(i), ...lines]);
    }, () => { view.tip.hide(); if (o.linked) run.point(null); else place(null); });
  };

  // A view with equal axes of the area [left, right] × [bottom, top]. `inner` draws with the scales it is given.
  const plane = (run, host, o) => {
    const p = run.data.estimate, width = host.clientWidth;
    const spanX = Math.max(o.right - o.left, 2), spanY = Math.max(o.top - o.bottom, 2);
    const inset = o.inset, most = Math.min(o.height, Math.max(260, width * 1.15));
    const scale = Math.min((width - 2 * inset) / spanX, (most - 2 * inset) / spanY);
    const height = o.fill ? most : Math.min(most, Math.max(200, spanY * scale + 2 * inset));
    const sx = (v) => width / 2 + (v - (o.left + o.right) / 2) * scale;
    const sy = (v) => height / 2 - (v - (o.bottom + o.top) / 2) * scale;
    const a = { sx, sy, scale, width, height };
    let svg = o.inner(a);
    const curve = (q) => path(q.x.map(sx), q.y.map(sy));
    if (run.data.truth.x.length) svg += `<path class="truthline" style="stroke-width:${o.night ? 4 : 5.5}" d="${curve(run.data.truth)}"/>`;
    const blue = o.night ? '#ffffff' : 'var(--estimate)';
    if (o.night) svg += `<path fill="none" stroke="#000" stroke-opacity=".6" stroke-width="4" d="${curve(p)}"/>`;
    svg += `<path class="estimateline" style="stroke:${blue}" d="${curve(p)}"/>`;
    const last = p.x.length - 1, ring = o.night ? '#0b1017' : 'var(--panel)';
    svg += `<rect x="${px(sx(p.x[last]) - 5)}" y="${px(sy(p.y[last]) - 5)}" width="10" height="10" rx="2" fill="var(--bad)" stroke="${ring}" stroke-width="1.5"/>` +
      `<circle cx="${px(sx(p.x[0]))}" cy="${px(sy(p.y[0]))}" r="5.5" fill="var(--ok)" stroke="${ring}" stroke-width="1.5"/>`;
    const bar = stepOf(width / scale * 0.22, 1) > width / scale * 0.4 ? stepOf(width / scale * 0.1, 1) : stepOf(width / scale * 0.2, 1);
    svg += `<path class="scalebar" d="M14 ${height - 20}v6h${px(bar * scale)}v-6"/>` +
      `<text class="strong" x="${px(14 + bar * scale / 2)}" y="${height - 22}" text-anchor="middle">${bar >= 1 ? bar : bar.toFixed(2)} m</text>`;
    svg += '<circle class="dot" r="5" visibility="hidden"/>';
    const view = mount(host, o.legend, svg, width, height, o.night);
    const dot = view.svg.querySelector('.dot');
    run.listeners.push((i) => {
      dot.setAttribute('visibility', i === null ? 'hidden' : 'visible');
      if (i !== null) { dot.setAttribute('cx', px(sx(p.x[i]))); dot.setAttribute('cy', px(sy(p.y[i]))); }
    });
    track(view.svg, (x, y) => {
      let best = 0, least = Infinity;
      for (let i = 0; i < p.x.length; ++i) {
        const d = (sx(p.x[i]) - x) ** 2 + (sy(p.y[i]) - y) ** 2;
        if (d < least) { least = d; best = i; }
      }
      run.point(best);
      view.tip.at(sx(p.x[best]), sy(p.y[best]), run.describe(best));
    }, () => { view.tip.hide(); run.point(null); });
  };
  const ends = [{ name: 'start', color: 'var(--ok)', kind: 'box' }, { name: 'end', color: 'var(--bad)', kind: 'box' }];
  const pair = (run) => [{ name: 'estimate', color: 'var(--estimate)' },
    ...(run.data.truth.x.length ? [{ name: 'truth', color: 'var(--truth)' }] : [])];

  const statusColor = (name) => ({ ok: 'var(--ok)', recovered: 'var(--back)', initialising: 'var(--d)', degenerate: 'var(--weak)',
    few_correspondences: 'var(--c)', lost: 'var(--bad)', empty: 'var(--other)' })[name] || 'var(--other)';
  const initialColor = (name) => ({ prediction: 'var(--a)', coarse: 'var(--b)', identity: 'var(--d)' })[name] || 'var(--other)';
  const stageColors = ['var(--d)', 'var(--c)', 'var(--a)', 'var(--b)'];

  const charts = {
    top(run, host) {
      const { estimate: p, truth: t } = run.data;
      const [left, right] = range(p.x, t.x), [bottom, top] = range(p.y, t.y);
      const tall = window.innerWidth > 900 ? 566 : 460;
      plane(run, host, {
        left, right, bottom, top, inset: 34, height: tall, fill: window.innerWidth > 900, legend: legend([...pair(run), ...ends]),
        inner: (a) => {
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
            if (y < 18) continue;  // the labels of x stand there
            svg += `<line class="gridline" x1="0" x2="${a.width}" y1="${px(y)}" y2="${px(y)}"/>`;
            if (y > 24 && y < a.height - 40) svg += `<text x="${a.width - 4}" y="${px(y - 3)}" text-anchor="end">${text(k * step)}</text>`;
          }
          return svg;
        },
      });
    },
    map(run, host) {
      const m = run.data.map;
      if (!m) return;
      const right = m.left + m.width * m.scale, bottom = m.top - m.height * m.scale;
      const ramp = `linear-gradient(90deg, ${m.colours.map((c) => `rgb(${c})`).join(', ')})`;
      const entries = [{ name: 'estimate', color: '#ffffff; box-shadow: 0 0 0 1px var(--muted)' }, ...pair(run).slice(1), ...ends,
        { name: `height ${m.low} m … ${m.high} m and more`, color: ramp, kind: 'ramp' }];
      plane(run, host, {
        left: m.left, right, bottom, top: m.top, inset: 0, height: 680, night: true, legend: legend(entries),
        inner: (a) => `<image href="${m.url}" x="${px(a.sx(m.left))}" y="${px(a.sy(m.top))}" width="${px(m.width * m.scale * a.scale)}" ` +
          `height="${px(m.height * m.scale * a.scale)}" preserveAspectRatio="none"/>`,
      });
    },
    side(run, host) {
      const { estimate: p, truth: t } = run.data;
      const series = [{ name: 'estimate', y: p.z, color: 'var(--estimate)', digits: 2, unit: 'm' }];
      if (t.z.length) series.unshift({ name: 'truth', x: distances(t), y: t.z, color: 'var(--truth)', digits: 2, unit: 'm', truth: true });
      curves(run, host, { height: 222, x: run.distance, series, xlabel: 'distance (m)', xname: run.where, linked: true });
    },
    speed(run, host) {
      const step = run.distance.map((d, i) => (i ? d - run.distance[i - 1] : null));
      curves(run, host, { height: 222, x: run.distance, zero: true, xlabel: 'distance (m)', xname: run.where, linked: true,
        series: [{ name: 'travel', y: step, color: 'var(--a)', digits: 3, unit: 'm' }] });
    },
    error(run, host) {
      const e = run.data.errors;
      curves(run, host, { height: 222, x: e.distance, zero: true, xlabel: 'distance (m)', xname: (i) => `${show(e.distance[i], 1)} m`,
        linked: run.paired, series: [{ name: 'error', y: e.translation, color: 'var(--c)', digits: 3, unit: 'm' }] });
    },
    axes(run, host) {
      const e = run.data.errors;
      curves(run, host, { height: 220, x: e.distance, xlabel: 'distance (m)', xname: (i) => `${show(e.distance[i], 1)} m`, linked: run.paired,
        series: [{ name: 'along track', y: e.along, color: 'var(--a)', digits: 3, unit: 'm' },
          { name: 'cross track (left)', y: e.cross, color: 'var(--b)', digits: 3, unit: 'm' },
          { name: 'height', y: e.height, color: 'var(--c)', digits: 3, unit: 'm' }] });
    },
    rotation(run, host) {
      const e = run.data.errors;
      curves(run, host, { height: 220, x: e.distance, zero: true, xlabel: 'distance (m)', xname: (i) => `${show(e.distance[i], 1)} m`,
        linked: run.paired, series: [{ name: 'rotation error', y: e.rotation, color: 'var(--d)', digits: 3, unit: '°' }] });
    },
    timing(run, host) {
      const s = run.data.sweeps, stages = s.stages.map(([name, column], k) => ({ name, column, color: stageColors[k] })).filter((stage) => stage.column.some((v) => v > 0));
      const levels = [{ name: 'median', y: s.median, color: 'var(--text)', dash: '6 4' }, { name: 'p95', y: s.p95, color: 'var(--weak)', dash: '6 4' },
        { name: 'p99', y: s.p99, color: 'var(--bad)', dash: '6 4' }, { name: 'sweep period', y: s.period, color: 'var(--other)', dash: '2 4' }];
      const top = Math.min(s.max, Math.max(2.5 * s.p95, s.max > s.period ? 1.1 * s.period : 0));
      const above = run.sweep.filter((i) => s.total[i] > 1.06 * top);
      const head = legend([...stages.map(({ name, color }) => ({ name, color, kind: 'box' })),
        ...levels.map((l) => ({ name: l.name, value: `${show(l.y, 1)} ms`, color: l.color, kind: 'dash' })),
        { name: 'max', value: `${show(s.max, 1)} ms` },
        ...(above.length ? [{ name: 'beyond the scale', value: String(above.length), color: 'var(--bad)', kind: 'box' }] : [])]);
      curves(run, host, {
        height: 250, x: run.sweep, zero: true, ymax: top, levels, legend: head, xlabel: 'sweep', xname: (i) => `sweep ${i}`, linked: true,
        series: [{ name: 'total', y: s.total, color: stages.length ? 'var(--text)' : 'var(--a)', digits: 1, unit: 'ms' }],
        under: (a) => stacked(a, run.sweep, stages),
        over: (a) => above.map((i) => `<path fill="var(--bad)" d="M${px(a.sx(i) - 4)} ${a.m.top + 7}h8l-4 -7z"/>`).join(''),
      });
    },
    histogram(run, host) {
      // The rare slow sweeps share the last bar, or they would leave no room for the others.
      const s = run.data.sweeps, low = range(s.total)[0], high = Math.min(s.max, 2 * s.p95);
      const width = stepOf(Math.max(high - low, 1e-3), Math.min(30, Math.max(8, 1.5 * Math.sqrt(s.total.length))));
      const first = Math.floor(low / width), last = Math.floor(high / width) - first;
      const counts = new Array(last + 1).fill(0);
      for (const v of s.total) if (finite(v)) ++counts[Math.min(Math.floor(v / width) - first, last)];
      const beyond = s.total.filter((v) => finite(v) && v >= (first + last + 1) * width).length;
      const a = axes(host, { height: 250, xlabel: 'ms per sweep', xrange: [first * width, (first + last + 1) * width], yrange: [0, range(counts)[1] * 1.06] });
      let svg = a.svg;
      counts.forEach((c, b) => {
        const x = a.sx((first + b) * width), x2 = a.sx((first + b + 1) * width), color = b === last && beyond ? 'var(--bad)' : 'var(--a)';
        if (c) svg += `<rect x="${px(x + 0.5)}" y="${px(a.sy(c))}" width="${px(Math.max(1, x2 - x - 1))}" height="${px(a.sy(0) - a.sy(c))}" rx="1.5" fill="${color}"/>`;
      });
      const marks = [['median', s.median, 'var(--text)'], ['p95', s.p95, 'var(--weak)'], ['p99', s.p99, 'var(--bad)']];
      for (const [, v, color] of marks) {
        if (v >= a.x0 && v <= a.x1) svg += `<line class="level" stroke="${color}" stroke-dasharray="6 4" x1="${px(a.sx(v))}" x2="${px(a.sx(v))}" y1="${a.m.top}" y2="${a.m.top + a.h}"/>`;
      }
      const entries = marks.map(([name, v, color]) => ({ name, value: `${show(v, 1)} ms`, color, kind: 'dash' }));
      if (beyond) entries.push({ name: 'beyond the scale', value: String(beyond), color: 'var(--bad)', kind: 'box' });
      const view = mount(host, legend(entries), svg, a.width, a.height);
      track(view.svg, (x, y) => {
        const b = Math.floor((a.x0 + (x - a.m.left) / a.w * (a.x1 - a.x0)) / width) - first;
        if (b < 0 || b > last) { view.tip.hide(); return; }
        const to = b === last && beyond ? show(s.max, 1) : show((first + b + 1) * width, 1);
        view.tip.at(x, y, [`${show((first + b) * width, 1)} … ${to} ms`, `${counts[b]} sweeps`]);
      }, view.tip.hide);
    },
    status(run, host) {
      const s = run.data.sweeps, n = s.total.length, rows = [['status', s.status, statusColor], ['initial pose', s.initial, initialColor]];
      const width = host.clientWidth, left = 88, w = width - left - 12, band = 24, gap = 10;
      const sx = (i) => left + i / n * w;
      let svg = '', head = '';
      rows.forEach(([title, column, color], r) => {
        const y = 4 + r * (band + gap), counts = column.names.map(() => 0);
        svg += `<text x="${left - 8}" y="${y + 16}" text-anchor="end">${title}</text>`;
        for (let i = 0; i < n;) {
          let j = i;
          while (j < n && column.codes[j] === column.codes[i]) ++j;
          counts[column.codes[i]] += j - i;
          svg += `<rect x="${px(sx(i))}" y="${y}" width="${px(Math.max(1.5, sx(j) - sx(i)))}" height="${band}" fill="${color(column.names[column.codes[i]])}"/>`;
          i = j;
        }
        head += legend(column.names.map((name, k) => ({ name: `${(name || 'unknown').replace(/_/g, ' ')}`, value: String(counts[k]), color: color(name), kind: 'box' })));
      });
      const bottom = 4 + rows.length * (band + gap);
      for (const t of ticks(0, n, Math.max(2, w / 90))) svg += `<text x="${px(sx(t.v))}" y="${bottom + 8}" text-anchor="middle">${t.text}</text>`;
      svg += `<line class="cursor" y1="0" y2="${bottom - gap + 4}" visibility="hidden"/>`;
      const view = mount(host, head, svg, width, bottom + 14);
      const line = view.svg.querySelector('.cursor');
      run.listeners.push((i) => {
        line.setAttribute('visibility', i === null ? 'hidden' : 'visible');
        if (i !== null) for (const end of ['x1', 'x2']) line.setAttribute(end, px(sx(i + 0.5)));
      });
      track(view.svg, (x, y) => {
        const i = Math.max(0, Math.min(n - 1, Math.floor((x - left) / w * n)));
        run.point(i);
        view.tip.at(x, y, [`sweep ${i}`, ...rows.map(([title, column]) => `${title}: ${column.names[column.codes[i]]}`)]);
      }, () => { view.tip.hide(); run.point(null); });
    },
    strips(run, host) {
      const s = run.data.sweeps;
      const rows = [['σ_th (m)', s.sigma, 'var(--c)', 3, 'm'], ['inlier ratio', s.inliers, 'var(--b)', 3, ''], ['iterations', s.iterations, 'var(--a)', 0, '']];
      host.innerHTML = rows.map(([title]) => `<p class="striptitle">${title}</p><div class="chart"></div>`).join('');
      const hosts = host.querySelectorAll('.chart');
      rows.forEach(([name, y, color, digits, unit], k) => curves(run, hosts[k], {
        height: k === rows.length - 1 ? 132 : 112, x: run.sweep, zero: true, legend: '', xlabel: k === rows.length - 1 ? 'sweep' : '',
        xname: (i) => `sweep ${i}`, linked: true, series: [{ name: name.replace(' (m)', ''), y, color, digits, unit }],
      }));
    },
  };

  // Stages on top of one another, averaged over the sweeps that share a pixel.
  function stacked(a, x, stages) {
    const n = x.length, bins = Math.min(n, Math.ceil(a.w)), xs = [], base = new Array(bins).fill(0);
    for (let b = 0; b < bins; ++b) xs.push(a.sx(x[Math.floor((b + 0.5) * n / bins)]));
    return stages.map(({ column, color }) => {
      const low = base.map((v) => a.sy(Math.min(v, a.y1)));
      for (let b = 0; b < bins; ++b) {
        const from = Math.floor(b * n / bins), to = Math.floor((b + 1) * n / bins);
        let sum = 0;
        for (let i = from; i < to; ++i) sum += column[i] || 0;
        base[b] += sum / (to - from);
      }
      const high = base.map((v) => a.sy(Math.min(v, a.y1)));
      const d = path([...xs, ...xs.slice().reverse()], [...high, ...low.reverse()]);
      return `<path d="${d}Z" fill="${color}" fill-opacity=".55"/>`;
    }).join('');
  }

  const prepare = (article) => {
    const data = JSON.parse(article.querySelector('script[type="application/json"]').textContent);
    const distance = distances(data.estimate);
    const run = { data, distance, listeners: [], sweep: distance.map((_, i) => i) };
    run.paired = Boolean(data.errors) && data.errors.distance.length === distance.length;
    run.point = (i) => { for (const listener of run.listeners) listener(i); };
    run.where = (i) => `sweep ${i}, ${show(distance[i], 1)} m`;
    run.describe = (i) => {
      const p = data.estimate, lines = [run.where(i), `x ${show(p.x[i], 2)}  y ${show(p.y[i], 2)}  z ${show(p.z[i], 2)} m`];
      if (run.paired) lines.push(`error ${show(data.errors.translation[i], 3)} m, ${show(data.errors.rotation[i], 3)}°`);
      if (data.sweeps) lines.push(`${show(data.sweeps.total[i], 1)} ms, ${data.sweeps.status.names[data.sweeps.status.codes[i]]}`);
      return lines;
    };
    return () => {
      run.listeners = [];
      for (const host of article.querySelectorAll('[data-chart]')) charts[host.dataset.chart](run, host);
    };
  };
  const redraws = Array.from(document.querySelectorAll('.run'), prepare);
  let drawn = -1;
  const redraw = () => {
    const width = document.documentElement.clientWidth;
    if (width === drawn) return;
    drawn = width;
    for (const draw of redraws) draw();
  };
  redraw();
  window.addEventListener('resize', () => window.requestAnimationFrame(redraw));
})();
