// How many pixels the picture has. While it moves, as many as the browser can draw in time, since one that draws with the processor is slow;
// when it has come to rest it is drawn once more with so many that edges are smooth.

const SLOW = 36; // ms between two frames, from which on there are too many pixels
const FAST = 22;
const LEAST = 0.5;
const FINEST = 2;
const REST = 180; // ms without a change
const SHARE = 0.15; // of a new gap in the mean

export class Sharpness {
  constructor(ratio = () => globalThis.devicePixelRatio || 1) {
    this.ratio = ratio;
    this.moving = 1; // part of the screen's pixels while the picture moves
    this.gap = (SLOW + FAST) / 2; // ms between frames, the mean
    this.drawn = -Infinity; // ms
    this.fine = true; // whether what is seen is as fine as it can be
  }

  // Pixels for each pixel of the page, of a picture that is to be drawn now; 0 if none is. changed: whether it is another than before.
  at(now, changed) {
    const since = now - this.drawn;
    if (changed) {
      if (since < 5 * SLOW) this.#pace(since);
      this.drawn = now;
      this.fine = false;
      return Math.min(this.ratio(), FINEST) * this.moving;
    }
    if (this.fine || since < REST) return 0;
    this.fine = true;
    return FINEST;
  }

  #pace(gap) {
    this.gap += (gap - this.gap) * SHARE;
    if (this.gap > SLOW && this.moving > LEAST) this.#change(0.8);
    else if (this.gap < FAST && this.moving < 1) this.#change(1.15);
  }

  #change(factor) {
    this.moving = Math.max(LEAST, Math.min(1, this.moving * factor));
    this.gap = (SLOW + FAST) / 2;
  }
}
