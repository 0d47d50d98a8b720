// Finds what is on the page, draws it, and draws it again when the width changes or something is unfolded.
const dataOf = (article) => JSON.parse(article.querySelector(':scope > script[type="application/json"]').textContent);
const drawAll = (article, functions, subject) => {
  for (const host of article.querySelectorAll('[data-chart]')) if (host.clientWidth) functions[host.dataset.chart](subject, host);
};
const runs = Array.from(document.querySelectorAll('article.run'), (article) => {
  const run = runOf(dataOf(article));
  run.draw = () => { run.listeners = []; drawAll(article, charts, run); };
  return run;
});
const comparisons = Array.from(document.querySelectorAll('article.comparison'), (article) => {
  const comparison = comparisonOf(dataOf(article), runs);
  comparison.draw = () => drawAll(article, comparisonCharts, comparison);
  choose(comparison, article.querySelector('.chooser'));
  return comparison;
});
const experiments = Array.from(document.querySelectorAll('article.experiment'), (article) => {
  const experiment = { data: dataOf(article), figure: 0 };
  experiment.draw = () => drawAll(article, experimentCharts, experiment);
  return experiment;
});
const draw = () => { for (const part of [...runs, ...comparisons, ...experiments]) part.draw(); };
let drawn = -1;
const redraw = () => {
  const width = document.documentElement.clientWidth;
  if (width !== drawn) { drawn = width; draw(); }
};
redraw();
window.addEventListener('resize', () => window.requestAnimationFrame(redraw));
for (const fold of document.querySelectorAll('details')) fold.addEventListener('toggle', draw);
