// Frames per second, and how many points they allow.
const GOAL_MS = 1000 / 30;
// Fewer would not make a frame much faster, and would not be a map any more.
const LEAST_POINTS = 60000;

const thousands = (count) => (count >= 1e6 ? `${(count / 1e6).toFixed(2)} M` : `${Math.round(count / 1000)} k`);

export class Rate {
  constructor(text, choice) {
    this.text = text;
    this.choice = choice;
    this.fitting = 1; // share of the map's points that can be drawn in time
    this.usual = GOAL_MS;
    this.drawn = 0;
  }

  get share() {
    return this.choice.value === 'all' ? 1 : this.fitting;
  }

  get fps() {
    return 1000 / this.usual;
  }

  /// Nothing was drawn: the next interval does not measure drawing.
  rest() {
    this.last = null;
  }

  drew(now, points, all) {
    this.drawn = points;
    if (this.last) {
      this.usual += 0.2 * (Math.min(now - this.last, 1000) - this.usual);
      // Far from the goal in large steps: a slow machine must not take a minute to get there.
      if (this.usual > GOAL_MS * 1.05) this.fitting *= Math.max(0.8, (GOAL_MS / this.usual) ** 0.25);
      else if (this.usual < GOAL_MS * 0.8) this.fitting *= 1.02;
      this.fitting = Math.min(1, Math.max(this.fitting, LEAST_POINTS / Math.max(all, 1)));
    }
    this.last = now;
    if (now - (this.told ?? -1e9) < 500) return;
    this.told = now;
    this.text.textContent = `${this.fps.toFixed(0)} fps · ${thousands(points)} points · map ${thousands(all)}`;
  }
}
