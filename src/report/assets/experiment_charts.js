// The charts of an experiment: configurations × sequences.
const figureChooser = (experiment) => `<label class="figure">Figure <select>${experiment.data.figures.map((figure, n) =>
  `<option value="${n}" ${n === experiment.figure ? 'selected' : ''}>${esc(figure.title)}${figure.unit ? ` (${esc(figure.unit)})` : ''}</option>`).join('')}</select></label>`;
const choosesFigure = (experiment, host) => {
  host.querySelector('select').addEventListener('change', (e) => {
    experiment.figure = Number(e.target.value);
    const place = e.target.closest('[data-chart]');
    experiment.draw();
    place.querySelector('select').focus();
  });
};

const experimentCharts = {
  cells(experiment, host) {
    const { sequences, configurations, figures } = experiment.data, figure = figures[experiment.figure];
    const rows = (values) => configurations.map((name, k) => ({ name, value: values[k], color: runColor(k) })).filter((row) => row.value !== null);
    const mean = figure.common > 1
      ? [barPanel(`Mean of ${figure.common} sequences`, figure.unit, rows(figure.means), figure.digits)] : [];
    const panels = sequences.map((name, s) => [name, rows(figure.values[s])]).filter(([, list]) => list.length)
      .map(([name, list]) => barPanel(name, figure.unit, list, figure.digits));
    host.innerHTML = `${figureChooser(experiment)}<div class="barpanels">${[...mean, ...panels].join('')}</div>`;
    choosesFigure(experiment, host);
  },
  sensitivity(experiment, host) {
    const { sequences, configurations, sensitivities, figures } = experiment.data, figure = figures[experiment.figure];
    const kept = sensitivities.map((series) => ({ ...series, lines: changes(series, figure, configurations, sequences) })).filter(({ lines }) => lines.length);
    host.innerHTML = figureChooser(experiment) + (kept.length ? '' : '<p class="empty">No sequence has this figure for all values of a key.</p>') +
      legend(kept.length ? [{ name: 'mean of the sequences', color: 'var(--text)' }, ...kept[0].lines.slice(0, -1).map((line) => ({ name: line.name, color: line.color })),
        { name: 'the base', color: 'var(--other)', kind: 'dash' }] : []) +
      `<div class="keys">${kept.map(({ key }) => `<div><p class="striptitle">${esc(key)}</p><div class="chart"></div></div>`).join('')}</div>`;
    choosesFigure(experiment, host);
    const hosts = host.querySelectorAll('.keys .chart');
    kept.forEach(({ points, base, lines, key }, n) => {
      const x = points.map(([value]) => value), at = points.findIndex(([, name]) => name === base);
      const beyond = Math.max(...lines.flatMap((line) => line.y)) > 300;
      curves(null, hosts[n], {
        height: 230, x, xlabel: key, xname: (i) => `${key} = ${x[i]}`, series: lines, legend: '', ylabel: 'change (%)', ymax: beyond ? 300 : undefined,
        levels: [{ y: 0, color: 'var(--other)', dash: '3 3' }],
        under: (a) => (at < 0 ? '' : `<line class="level" stroke="var(--other)" stroke-dasharray="3 3" x1="${px(a.sx(x[at]))}" x2="${px(a.sx(x[at]))}" y1="${a.m.top}" y2="${a.m.top + a.h}"/>`),
      });
    });
  },
};

// Change against the base in per cent, one line per sequence that has all values, the geometric mean last.
function changes({ points, base }, figure, configurations, sequences) {
  const places = points.map(([, name]) => configurations.indexOf(name)), from = configurations.indexOf(base), lines = [];
  const sums = points.map(() => 0);
  sequences.forEach((name, s) => {
    const row = figure.values[s], values = places.map((k) => row[k]);
    if (!(row[from] > 0) || values.some((v) => !(v > 0))) return;
    values.forEach((v, i) => { sums[i] += Math.log(v / row[from]); });
    lines.push({
      name, y: values.map((v) => 100 * (v / row[from] - 1)), color: runColor(s), dash: runDash(s), digits: 1, unit: '%', width: 1.2, dots: 2,
      text: (i) => `${show(values[i], figure.digits)} ${figure.unit} (${values[i] >= row[from] ? '+' : ''}${show(100 * (values[i] / row[from] - 1), 1)} %)`,
    });
  });
  if (!lines.length) return [];
  return [...lines, { name: 'mean', y: sums.map((sum) => 100 * (Math.exp(sum / lines.length) - 1)), color: 'var(--text)', digits: 1, unit: '%', width: 3, dots: 4 }];
}
