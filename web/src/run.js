// What is known of the run, and the sweep that is shown: no drawing here.
import { requestFollow, requestSweep } from './protocol.js';

const KEPT_SWEEPS = 48;

export class Run extends EventTarget {
  constructor(send) {
    super();
    this.send = send;
    this.reset();
  }

  /// At every new connection: the program may be another one.
  reset() {
    this.info = null;
    this.records = [];
    this.seconds = []; // since the first sweep
    this.metres = []; // travelled
    this.progress = { finished: false, sweeps: 0, total: 0, dropped: 0 };
    this.sweeps = new Map(); // by number, as many as fit
    this.shown = -1;
    this.newest = true; // stay at the newest sweep
    this.playing = false;
    this.asked = null; // the sweep that is on its way
    this.sweep = null;
    this.sound('reset');
  }

  sound(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  take(frame) {
    if (frame.type === 'info') {
      this.info = frame;
      this.newest = frame.live;
      if (!frame.live) this.send(requestFollow(false));
      this.sound('info');
    } else if (frame.type === 'records') {
      this.addRecords(frame);
    } else if (frame.type === 'progress') {
      if (frame.dropped < this.progress.dropped) this.forgetStandIns();
      this.progress = frame;
      this.sound('progress');
    } else if (frame.type === 'sweep') {
      this.addSweep(frame);
    } else if (frame.type === 'map') {
      this.sound('map', frame);
    }
  }

  addRecords({ first, list }) {
    if (first !== this.records.length) return; // sent once and in order
    for (const record of list) {
      const before = this.records.at(-1);
      const step = before ? Number(record.stampNs - before.stampNs) * 1e-9 : 0;
      const usable = step > 0 && step < 60 ? step : before ? 0.1 : 0;
      const moved = before ? Math.hypot(...record.position.map((p, i) => p - before.position[i])) : 0;
      this.seconds.push((this.seconds.at(-1) ?? 0) + usable);
      this.metres.push((this.metres.at(-1) ?? 0) + moved);
      this.records.push(record);
    }
    this.sound('records', first);
    if (this.newest) this.show(this.records.length - 1, true);
    else if (this.shown < 0) {
      this.show(0);
      if (!this.info?.live) this.play(true);
    }
  }

  addSweep(frame) {
    this.sweeps.set(frame.number, frame);
    if (this.sweeps.size > KEPT_SWEEPS) this.sweeps.delete(this.sweeps.keys().next().value);
    if (this.asked !== null) {
      const asked = this.asked;
      this.asked = null;
      // The program keeps every n-th sweep of a long run: it sent the nearest one in place of the one asked for.
      if (asked !== frame.number) this.sweeps.set(asked, frame);
      if (asked !== this.shown && !this.newest) this.fetch();
    }
    if (this.newest || this.sweeps.get(this.shown) === frame || this.sweep === null) this.useSweep(frame);
  }

  /// Points of sweeps that were missing have arrived.
  forgetStandIns() {
    for (const [number, frame] of this.sweeps) {
      if (frame.number !== number) this.sweeps.delete(number);
    }
  }

  useSweep(frame) {
    if (this.sweep === frame || !this.records[frame.number]) return;
    this.sweep = frame;
    this.sound('sweep', frame);
  }

  fetch() {
    const kept = this.sweeps.get(this.shown);
    if (kept) this.useSweep(kept);
    else if (this.asked === null && this.info?.points) {
      this.asked = this.shown;
      this.send(requestSweep(this.shown));
    }
  }

  /// Shows a sweep; `newest`: and follows the newest from now on.
  show(number, newest = false) {
    const last = this.records.length - 1;
    if (last < 0) return;
    if (newest !== this.newest) {
      this.newest = newest;
      this.send(requestFollow(newest));
      this.sound('mode');
    }
    this.shown = Math.max(0, Math.min(last, Math.round(number)));
    if (!newest || this.progress.finished) this.fetch();
    this.sound('shown');
  }

  play(on) {
    if (on && !this.newest && this.shown >= this.records.length - 1 && this.progress.finished) this.show(0);
    if (on && this.newest && this.progress.finished) this.show(0);
    this.playing = on;
    if (!on && this.newest) this.show(this.shown);
    this.at = this.seconds[this.shown] ?? 0;
    this.sound('mode');
  }

  /// Advances playback by seconds of the drive.
  advance(seconds) {
    if (!this.playing || this.newest || this.shown < 0) return;
    this.at += seconds;
    let next = this.shown;
    while (next + 1 < this.records.length && this.seconds[next + 1] <= this.at) ++next;
    if (next !== this.shown) this.show(next);
    if (next === this.records.length - 1 && this.progress.finished) this.play(false);
    else if (next === this.records.length - 1) this.at = this.seconds[next];
  }
}
