// The charts of one run.
const ends = [{ name: 'start', color: 'var(--ok)', kind: 'box' }, { name: 'end', color: 'var(--bad)', kind: 'box' }];
const pair = (run) => [{ name: 'estimate', color: 'var(--estimate)' },
  ...(run.data.truth.x.length ? [{ name: 'truth', color: 'var(--truth)' }] : [])];

const statusColor = (name) => ({ ok: 'var(--ok)', recovered: 'var(--back)', initialising: 'var(--d)', degenerate: 'var(--weak)',
  lost: 'var(--bad)', empty: 'var(--other)' })[name] || 'var(--other)';
const initialColor = (name) => ({ prediction: 'var(--a)', coarse: 'var(--b)', identity: 'var(--d)' })[name] || 'var(--other)';
const stageColors = ['var(--d)', 'var(--c)', 'var(--a)', 'var(--b)'];

// The run's trajectory and truth for plane().
const seen = (run, color) => ({
  truth: run.data.truth, paths: [{ p: run.data.estimate, color }], describe: (n, i) => run.describe(i),
  point: (n, i) => run.point(n === null ? null : i),
  follow: (place) => run.listeners.push((i) => place(i === null ? null : 0, i)),
});
const edges = (m) => ({ left: m.left, right: m.left + m.width * m.scale, bottom: m.top - m.height * m.scale, top: m.top });
const picture = (m) => (a) => `<image href="${m.url}" x="${px(a.sx(m.left))}" y="${px(a.sy(m.top))}" width="${px(m.width * m.scale * a.scale)}" ` +
  `height="${px(m.height * m.scale * a.scale)}" preserveAspectRatio="none"/>`;
const heights = (m) => ({
  name: `height ${m.low} m … ${m.high} m and more`, color: `linear-gradient(90deg, ${m.colours.map((c) => `rgb(${c})`).join(', ')})`, kind: 'ramp',
});

const charts = {
  top(run, host) {
    const { estimate: p, truth: t } = run.data;
    const [left, right] = range(p.x, t.x), [bottom, top] = range(p.y, t.y);
    const tall = window.innerWidth > 900 ? 566 : 460;
    plane(host, {
      ...seen(run, 'var(--estimate)'), left, right, bottom, top, inset: 34, height: tall, fill: window.innerWidth > 900,
      legend: legend([...pair(run), ...ends]), inner: coordinates(left, right, bottom, top),
    });
  },
  map(run, host) {
    const m = run.data.map;
    if (!m) return;
    const entries = [{ name: 'estimate', color: '#ffffff; box-shadow: 0 0 0 1px var(--muted)' }, ...pair(run).slice(1), ...ends, heights(m)];
    plane(host, {
      ...seen(run, '#ffffff'), ...edges(m), inset: 0, height: 680, night: true, legend: legend(entries), inner: picture(m),
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
    const above = run.sweep.filter((_, i) => s.total[i] > 1.06 * top);
    const head = legend([...stages.map(({ name, color }) => ({ name, color, kind: 'box' })),
      ...levels.map((l) => ({ name: l.name, value: `${show(l.y, 1)} ms`, color: l.color, kind: 'dash' })),
      { name: 'max', value: `${show(s.max, 1)} ms` },
      ...(above.length ? [{ name: 'beyond the scale', value: String(above.length), color: 'var(--bad)', kind: 'box' }] : [])]);
    curves(run, host, {
      height: 250, x: run.sweep, whole: true, zero: true, ymax: top, levels, legend: head, xlabel: 'sweep', xname: run.name, linked: true,
      series: [{ name: 'total', y: s.total, color: stages.length ? 'var(--text)' : 'var(--a)', digits: 1, unit: 'ms' }],
      under: (a) => stacked(a, run.sweep, stages),
      over: (a) => above.map((v) => `<path fill="var(--bad)" d="M${px(a.sx(v) - 4)} ${a.m.top + 7}h8l-4 -7z"/>`).join(''),
    });
  },
  histogram(run, host) {
    // The rare slow sweeps share the last bar, or they would leave no room for the others.
    const s = run.data.sweeps, low = range(s.total)[0], high = Math.min(s.max, 2 * s.p95);
    const width = stepOf(Math.max(high - low, 0.1 * high, 1e-3), Math.min(30, Math.max(8, 1.5 * Math.sqrt(s.total.length))));
    const first = Math.floor(low / width), last = Math.floor(high / width) - first;
    const counts = new Array(last + 1).fill(0);
    for (const v of s.total) if (finite(v)) ++counts[Math.min(Math.floor(v / width) - first, last)];
    const beyond = s.total.filter((v) => finite(v) && v >= (first + last + 1) * width).length;
    const a = axes(host, { height: 250, counts: true, xlabel: 'ms per sweep', xrange: [first * width, (first + last + 1) * width], yrange: [0, range(counts)[1] * 1.06] });
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
    const first = run.sweep[0], end = run.sweep[n - 1] + 1, sx = (v) => left + (v - first) / (end - first) * w;
    let svg = '', head = '';
    rows.forEach(([title, column, color], r) => {
      const y = 4 + r * (band + gap), counts = column.names.map(() => 0);
      svg += `<text x="${left - 8}" y="${y + 16}" text-anchor="end">${title}</text>`;
      for (let i = 0; i < n;) {
        let j = i;
        while (j < n && column.codes[j] === column.codes[i]) ++j;
        counts[column.codes[i]] += j - i;
        const x = sx(run.sweep[i]);
        svg += `<rect x="${px(x)}" y="${y}" width="${px(Math.max(1.5, sx(run.sweep[j - 1] + 1) - x))}" height="${band}" fill="${color(column.names[column.codes[i]])}"/>`;
        i = j;
      }
      head += legend(column.names.map((name, k) => ({ name: `${(name || 'unknown').replace(/_/g, ' ')}`, value: String(counts[k]), color: color(name), kind: 'box' })));
    });
    const bottom = 4 + rows.length * (band + gap);
    for (const t of ticks(first, end, Math.max(2, w / 90), 1)) svg += `<text x="${px(sx(t.v))}" y="${bottom + 8}" text-anchor="middle">${t.text}</text>`;
    svg += `<line class="cursor" y1="0" y2="${bottom - gap + 4}" visibility="hidden"/>`;
    const view = mount(host, head, svg, width, bottom + 14);
    const line = view.svg.querySelector('.cursor');
    run.listeners.push((i) => {
      line.setAttribute('visibility', i === null ? 'hidden' : 'visible');
      if (i !== null) for (const side of ['x1', 'x2']) line.setAttribute(side, px(sx(run.sweep[i] + 0.5)));
    });
    track(view.svg, (x, y) => {
      const i = nearest(run.sweep, first - 0.5 + (x - left) / w * (end - first));
      run.point(i);
      view.tip.at(x, y, [run.name(i), ...rows.map(([title, column]) => `${title}: ${column.names[column.codes[i]]}`)]);
    }, () => { view.tip.hide(); run.point(null); });
  },
  strips(run, host) {
    const s = run.data.sweeps;
    const rows = [['σ_th (m)', s.sigma, 'var(--c)', 3, 'm'], ['inliers per point', s.inliers, 'var(--b)', 3, ''], ['iterations', s.iterations, 'var(--a)', 0, '']];
    host.innerHTML = rows.map(([title]) => `<p class="striptitle">${title}</p><div class="chart"></div>`).join('');
    const hosts = host.querySelectorAll('.chart');
    rows.forEach(([name, y, color, digits, unit], k) => curves(run, hosts[k], {
      height: k === rows.length - 1 ? 132 : 112, x: run.sweep, whole: true, counts: name === 'iterations', zero: true, legend: '', xlabel: k === rows.length - 1 ? 'sweep' : '',
      xname: run.name, linked: true, series: [{ name: name.replace(' (m)', ''), y, color, digits, unit }],
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

const runOf = (data) => {
  const distance = distances(data.estimate);
  const run = { data, distance, listeners: [], sweep: data.numbers || distance.map((_, i) => i) };
  run.paired = Boolean(data.errors) && data.errors.distance.length === distance.length;
  run.point = (i) => { for (const listener of run.listeners) listener(i); };
  run.name = (i) => `sweep ${run.sweep[i]}`;
  run.where = (i) => `${run.name(i)}, ${show(distance[i], 1)} m`;
  run.describe = (i) => {
    const p = data.estimate, lines = [run.where(i), `x ${show(p.x[i], 2)}  y ${show(p.y[i], 2)}  z ${show(p.z[i], 2)} m`];
    if (run.paired) lines.push(`error ${show(data.errors.translation[i], 3)} m, ${show(data.errors.rotation[i], 3)}°`);
    if (data.sweeps) lines.push(`${show(data.sweeps.total[i], 1)} ms, ${data.sweeps.status.names[data.sweeps.status.codes[i]]}`);
    return lines;
  };
  return run;
};
