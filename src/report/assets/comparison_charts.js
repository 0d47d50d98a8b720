// The charts that compare the runs of one sequence. Runs that are switched off leave the axes to the others.
const kColours = 6;
const runColor = (k) => `var(--r${k % kColours})`;
// The second half of the colours, and every further round of them, differ by their dashes too.
const runDash = (k) => ['', '', '', '', '7 3', '3 3', '10 3', '10 3 2 3', '5 2', '2 4', '8 2 2 2', '4 4'][k % (2 * kColours)];

const comparisonOf = (data, runs) => {
  const all = data.runs.map((place, k) => ({
    k, name: data.names[k], run: runs[place], lengths: data.lengths[k], color: runColor(k), dash: runDash(k), on: true, from: 0,
  })).filter((entry) => entry.run);
  placeAlong(all.filter(hasPath));
  const comparison = { data, all };
  comparison.shown = (is) => all.filter((entry) => entry.on && (!is || is(entry)));
  comparison.truth = () => {
    const truths = all.map(({ run, from }) => ({ ...run.data.truth, from })).filter((t) => t.x.length);
    return truths.reduce((longest, t) => (t.x.length > longest.x.length ? t : longest), { x: [], y: [], z: [], from: 0 });
  };
  return comparison;
};
const hasErrors = ({ run }) => run.data.errors !== null;
const hasSweeps = ({ run }) => run.data.sweeps !== null;
const hasTimes = (entry) => hasSweeps(entry) && entry.run.data.sweeps.max > 0;
const hasPath = ({ run }) => run.data.estimate.x.length > 0;

// A run that begins later begins farther along the path, by as much as another one has gone until its first sweep.
function placeAlong(entries) {
  const placed = [], last = ({ run }) => run.sweep[run.sweep.length - 1];
  for (const entry of entries.filter(({ run }) => run.data.numbers).sort((a, b) => a.run.sweep[0] - b.run.sweep[0])) {
    const begin = entry.run.sweep[0], other = placed.find((before) => last(before) >= begin) || placed[placed.length - 1];
    if (other) entry.from = other.from + other.run.distance[nearest(other.run.sweep, begin)];
    placed.push(entry);
  }
}
const along = ({ from }, x) => x.map((v) => v + from);
const lineMark = ({ color, dash }) => `<svg class="mark" width="22" height="10" aria-hidden="true"><line x1="1" x2="21" y1="5" y2="5" ` +
  `style="stroke:${color}" stroke-width="3" ${dash ? `stroke-dasharray="${dash}"` : ''}/></svg>`;

// Of runs that coincide each shows on both sides of the ones after it.
const runWidth = (n, count) => 1.7 + Math.min(1.1, 4.4 / Math.max(1, count)) * (count - 1 - n);

// Buttons that switch runs on and off.
function choose(comparison, host) {
  host.innerHTML = comparison.all.map((entry) =>
    `<button type="button" aria-pressed="true">${lineMark(entry)}<span>${esc(entry.name)}</span></button>`).join('') +
    (comparison.truth().x.length ? '<span class="truthkey"><i></i>truth</span>' : '');
  host.querySelectorAll('button').forEach((button, n) => button.addEventListener('click', () => {
    comparison.all[n].on = !comparison.all[n].on;
    if (!comparison.shown().length) comparison.all[n].on = true;  // an empty chart is useless
    button.setAttribute('aria-pressed', String(comparison.all[n].on));
    comparison.draw();
  }));
}

// Rows of name, bar and number. Values far beyond the others are cut off, or these could not be distinguished.
function barRows(rows, digits) {
  const values = rows.map((row) => row.value).filter((v) => finite(v)).sort((a, b) => a - b);
  const median = values.length ? values[values.length >> 1] : 0, most = values.length ? values[values.length - 1] : 0;
  const top = (median > 0 && most > 6 * median ? values.filter((v) => v <= 6 * median).pop() * 1.25 : most) || 1;
  return rows.map(({ name, value, color }) => {
    const cut = value > top, width = finite(value) ? Math.min(100, Math.max(0, value / top * 100)) : 0;
    return `<tr><th scope="row">${esc(name)}</th><td class="track">${finite(value) ? `<i class="${cut ? 'cut' : ''}"${cut ? ' title="longer than shown"' : ''} style="width:${width.toFixed(1)}%;background-color:${color}"></i>` : ''}</td>` +
      `<td class="value">${finite(value) ? value.toFixed(digits) : '–'}</td></tr>`;
  }).join('');
}
const barPanel = (title, unit, rows, digits) => `<table class="bars"><caption>${esc(title)}${unit ? ` <span class="unit">${esc(unit)}</span>` : ''}</caption>` +
  `<tbody>${barRows(rows, digits)}</tbody></table>`;

function compareCurves(host, entries, o, extra) {
  const series = entries.map((entry, n) => ({ name: entry.name, color: entry.color, dash: entry.dash, width: runWidth(n, entries.length), digits: 3, unit: o.unit, ...o.of(entry) }))
    .filter((s) => s.x.length);
  if (!series.length) { host.innerHTML = '<p class="empty">None of the runs shown has it.</p>'; return; }
  const longest = series.reduce((best, s) => (s.x[s.x.length - 1] > best[best.length - 1] ? s.x : best), series[0].x);
  curves(null, host, {
    height: o.height || 220, x: longest, xlabel: 'distance (m)', zero: o.zero, legend: o.legend || '', ylabel: o.ylabel,
    xname: (i) => `${show(longest[i], 1)} m`, series: [...(extra || []), ...series], ...o.more,
  });
}

const comparisonCharts = {
  bars(comparison, host) {
    const panels = comparison.data.figures.filter((figure) => figure.values.some((v) => v !== null)).map((figure) =>
      barPanel(figure.title, figure.unit, comparison.shown().map((entry) => ({ name: entry.name, value: figure.values[entry.k], color: entry.color })), figure.digits));
    host.innerHTML = `<div class="barpanels">${panels.join('')}</div>`;
  },
  paths(comparison, host) {
    const entries = comparison.shown(hasPath), truth = comparison.truth(), tall = window.innerWidth > 900 ? 566 : 460;
    if (!entries.length) return;
    const [left, right] = range(truth.x, ...entries.map(({ run }) => run.data.estimate.x));
    const [bottom, top] = range(truth.y, ...entries.map(({ run }) => run.data.estimate.y));
    plane(host, {
      left, right, bottom, top, inset: 34, height: tall, fill: window.innerWidth > 900, inner: coordinates(left, right, bottom, top),
      legend: legend([{ name: 'start', color: 'var(--ok)', kind: 'box' }, { name: 'square: end' }]), truth, truthColor: 'var(--band)',
      paths: entries.map(({ run, color, dash }, n) => ({ p: run.data.estimate, color, dash, width: runWidth(n, entries.length) })),
      describe: (n, i) => [entries[n].name, ...entries[n].run.describe(i)],
    });
  },
  heights(comparison, host) {
    const truth = comparison.truth();
    const band = truth.x.length ? [{ name: 'truth', x: along(truth, distances(truth)), y: truth.z, color: 'var(--band)', digits: 2, unit: 'm', truth: true }] : [];
    compareCurves(host, comparison.shown(hasPath), { unit: 'm', ylabel: 'z (m)', height: 236, of: (entry) => ({ x: along(entry, entry.run.distance), y: entry.run.data.estimate.z, digits: 2 }) }, band);
  },
  patherror(comparison, host) {
    compareCurves(host, comparison.shown(hasErrors), {
      unit: 'm', ylabel: 'error (m)', zero: true, height: 236, of: (entry) => ({ x: along(entry, entry.run.data.errors.distance), y: entry.run.data.errors.translation }),
    });
  },
  drift(comparison, host) {
    const axes = [['along', 'along the track'], ['cross', 'across, to the left'], ['height', 'height']];
    host.innerHTML = `<div class="strips">${axes.map(([, title]) => `<div><p class="striptitle">${title} <span class="unit">m</span></p><div class="chart"></div></div>`).join('')}</div>`;
    const hosts = host.querySelectorAll('.chart');
    axes.forEach(([key], n) => compareCurves(hosts[n], comparison.shown(hasErrors), {
      unit: 'm', height: 190, of: (entry) => ({ x: along(entry, entry.run.data.errors.distance), y: entry.run.data.errors[key] }),
    }));
  },
  trel(comparison, host) { byLength(comparison, host, 1, 't_rel (%)', '%'); },
  rrel(comparison, host) { byLength(comparison, host, 2, 'r_rel (°/100 m)', '°/100 m'); },
  times(comparison, host) {
    const entries = comparison.shown(hasTimes);
    if (!entries.length) { host.innerHTML = '<p class="empty">None of the runs shown has times.</p>'; return; }
    const sweeps = entries.map(({ run }) => run.data.sweeps), row = 58, width = host.clientWidth, left = 8, right = 8;
    const top = Math.max(...sweeps.map((s) => Math.min(s.max, Math.max(1.15 * s.p99, 2 * s.median))));
    const step = stepOf(top, 40), bins = Math.ceil(top / step), end = bins * step, w = width - left - right;
    const sx = (v) => left + Math.min(v, end) / end * w, height = entries.length * row + 34;
    const counted = sweeps.map((s) => {
      const counts = new Array(bins).fill(0);
      for (const v of s.total) if (finite(v)) ++counts[Math.min(bins - 1, Math.max(0, Math.floor(v / step)))];
      return counts;
    });
    let svg = '';
    for (const t of ticks(0, end, Math.max(2, w / 68))) {
      svg += `<line class="gridline" x1="${px(sx(t.v))}" x2="${px(sx(t.v))}" y1="0" y2="${height - 32}"/>` +
        `<text x="${px(sx(t.v))}" y="${height - 18}" text-anchor="middle">${t.text}</text>`;
    }
    entries.forEach((entry, n) => {
      const base = (n + 1) * row - 4, most = Math.max(...counted[n], 1), s = sweeps[n];
      counted[n].forEach((count, b) => {
        if (!count) return;
        const h = Math.max(1.5, count / most * (row - 24));
        svg += `<rect x="${px(sx(b * step) + 0.5)}" y="${px(base - h)}" width="${px(Math.max(1, w / bins - 1))}" height="${px(h)}" fill="${entry.color}"/>`;
      });
      svg += `<line class="axis" x1="${left}" x2="${left + w}" y1="${base}" y2="${base}"/>`;
      for (const v of [s.median, s.p99]) svg += `<line class="level" stroke="var(--text)" stroke-dasharray="4 3" x1="${px(sx(v))}" x2="${px(sx(v))}" y1="${base - row + 22}" y2="${base}"/>`;
      svg += `<text class="halo strong" x="${left + w}" y="${base - row + 16}" text-anchor="end">${esc(entry.name)}: ${show(s.median, 1)} ms, p99 ${show(s.p99, 1)}</text>`;
    });
    svg += `<text x="${px(left + w / 2)}" y="${height - 3}" text-anchor="middle">ms per sweep; the last bar holds all slower ones</text>`;
    const view = mount(host, '', svg, width, height);
    track(view.svg, (x, y) => {
      const n = Math.min(entries.length - 1, Math.floor(y / row)), b = Math.min(bins - 1, Math.max(0, Math.floor((x - left) / w * bins)));
      view.tip.at(x, y, [entries[n].name, `${show(b * step, 1)} … ${show((b + 1) * step, 1)} ms${b === bins - 1 ? ' and more' : ''}`, `${counted[n][b]} of ${sweeps[n].total.length} sweeps`]);
    }, view.tip.hide);
  },
  statuses(comparison, host) {
    const entries = comparison.shown(hasSweeps);
    if (!entries.length) { host.innerHTML = '<p class="empty">None of the runs shown says anything about its sweeps.</p>'; return; }
    const first = Math.min(...entries.map(({ run }) => run.sweep[0])), end = Math.max(...entries.map(({ run }) => run.sweep[run.sweep.length - 1])) + 1;
    const row = 44, width = host.clientWidth, left = 8, w = width - 16;
    const sx = (v) => left + (v - first) / (end - first) * w, height = entries.length * row + 34, seenNames = new Set();
    let svg = '';
    entries.forEach((entry, k) => {
      const s = entry.run.data.sweeps.status, y = k * row + 18;
      svg += `<text class="strong" x="${left}" y="${y - 5}">${esc(entry.name)}</text>`;
      for (let i = 0; i < s.codes.length;) {
        let j = i;
        while (j < s.codes.length && s.codes[j] === s.codes[i]) ++j;
        const name = s.names[s.codes[i]];
        seenNames.add(name);
        const x = sx(entry.run.sweep[i]);
        svg += `<rect x="${px(x)}" y="${y}" width="${px(Math.max(1.5, sx(entry.run.sweep[j - 1] + 1) - x))}" height="20" fill="${statusColor(name)}"/>`;
        i = j;
      }
    });
    for (const t of ticks(first, end, Math.max(2, w / 90), 1)) {
      const anchor = t.v === first ? 'start' : sx(t.v) > width - 24 ? 'end' : 'middle';  // within the picture
      svg += `<text x="${px(sx(t.v))}" y="${height - 18}" text-anchor="${anchor}">${t.text}</text>`;
    }
    svg += `<text x="${px(left + w / 2)}" y="${height - 3}" text-anchor="middle">sweep</text>`;
    const head = legend([...seenNames].map((name) => ({ name: (name || 'unknown').replace(/_/g, ' '), color: statusColor(name), kind: 'box' })));
    const view = mount(host, head, svg, width, height);
    track(view.svg, (x, y) => {
      const k = Math.max(0, Math.min(entries.length - 1, Math.floor(y / row))), { run, name } = entries[k];
      const i = nearest(run.sweep, first - 0.5 + (x - left) / w * (end - first)), s = run.data.sweeps;
      view.tip.at(x, y, [name, run.where(i), `status: ${s.status.names[s.status.codes[i]]}`, `initial pose: ${s.initial.names[s.initial.codes[i]]}`]);
    }, view.tip.hide);
  },
  maps(comparison, host) {
    const entries = comparison.shown(({ run }) => run.data.map !== null);
    if (!entries.length) { host.innerHTML = '<p class="empty">None of the runs shown has a map.</p>'; return; }
    const boxes = entries.map(({ run }) => edges(run.data.map));
    const box = { left: Math.min(...boxes.map((b) => b.left)), right: Math.max(...boxes.map((b) => b.right)),
      bottom: Math.min(...boxes.map((b) => b.bottom)), top: Math.max(...boxes.map((b) => b.top)) };
    host.innerHTML = `${legend([heights(entries[0].run.data.map)])}<div class="maps">` +
      entries.map((entry) => `<figure><figcaption>${lineMark(entry)}${esc(entry.name)}</figcaption><div class="chart"></div></figure>`).join('') + '</div>';
    const hosts = host.querySelectorAll('.maps .chart');
    entries.forEach(({ run, name }, k) => plane(hosts[k], {
      ...box, inset: 0, height: 420, least: 120, night: true, legend: '', inner: picture(run.data.map), truth: run.data.truth,
      paths: [{ p: run.data.estimate, color: '#ffffff' }], describe: (n, i) => [name, ...run.describe(i)],
    }));
  },
};

// Column of the devkit's table over the length of the segments.
function byLength(comparison, host, column, ylabel, unit) {
  compareCurves(host, comparison.shown(({ lengths }) => lengths.length > 0), {
    unit, ylabel, zero: true, height: 230,
    of: ({ lengths }) => ({
      x: lengths.map((row) => row[0]), y: lengths.map((row) => row[column]), dots: 3.4,
      text: (i) => `${show(lengths[i][column], 3)} ${unit} (${lengths[i][3]} segments)`,
    }),
    more: { xlabel: 'length of the segments (m)' },
  });
}
