// How many pixels a picture may have while a run plays without a graphics card: fewer where it does not keep
// up.

const WANTED_MS = 1000 / 30, FRAMES = 10, STEP = 0.7, LEAST = 0.5;

export class Pace {
  constructor() {
    this.restart();
  }

  restart() {
    this.share = 1;  // of the pixels along each side
    this.since = undefined;
  }

  // Takes the time of a picture; changes the share every few pictures.
  note(time_ms) {
    if (this.since === undefined) {
      this.since = time_ms;
      this.frames = 0;
      return;
    }
    if (++this.frames < FRAMES) return;
    if ((time_ms - this.since) / FRAMES > WANTED_MS) this.share = Math.max(LEAST, STEP * this.share);
    this.since = time_ms;
    this.frames = 0;
  }
}
