// The slider, and over it a line of what each sweep was: status, and where the coarse stage was taken.
import { colour, onTheme } from './theme.js';

const COLOURS = { ok: 'good', initialising: 'good', recovered: 'warn', degenerate: 'warn', lost: 'bad', empty: 'bad' };

export class Timeline {
  constructor(run) {
    this.run = run;
    this.canvas = document.getElementById('marks');
    this.slider = document.getElementById('seek');
    this.slider.addEventListener('input', () => run.show(Number(this.slider.value)));
    onTheme(() => { this.stale = true; });
    new ResizeObserver(() => { this.stale = true; }).observe(this.canvas);
  }

  show(number) {
    this.slider.value = number;
    this.slider.setAttribute('aria-valuetext', `sweep ${number + 1} of ${this.run.records.length}`);
  }

  refresh(now) {
    if (!this.stale || now - (this.drawn ?? -1e9) < 200) return;
    this.drawn = now;
    this.stale = false;
    this.slider.max = Math.max(0, this.run.records.length - 1);
    this.slider.value = Math.max(0, this.run.shown);
    this.draw();
  }

  draw() {
    const { records, info } = this.run;
    const { canvas } = this;
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    const context = canvas.getContext('2d');
    const step = canvas.width / Math.max(1, records.length);
    let from = 0;
    for (let i = 1; i <= records.length; ++i) {
      if (i < records.length && records[i].status === records[from].status) continue;
      const name = COLOURS[info.status[records[from].status]] ?? 'muted';
      context.globalAlpha = name === 'good' ? 0.45 : 1;
      context.fillStyle = colour(name);
      context.fillRect(from * step, 0, Math.max(devicePixelRatio, (i - from) * step), canvas.height * 0.45);
      from = i;
    }
    context.globalAlpha = 1;
    context.fillStyle = colour('coarse');
    const coarse = info?.initial_pose.indexOf('coarse');
    records.forEach((record, i) => {
      if (record.source === coarse) context.fillRect(i * step, canvas.height * 0.55, Math.max(2 * devicePixelRatio, step), canvas.height * 0.45);
    });
  }
}
