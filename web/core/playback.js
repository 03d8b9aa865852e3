/** A clock that plays curves known to their end, as if the experiment were being done now. */

/** @typedef {ReturnType<typeof createPlayback>} Playback */

/** Seconds in which an experiment is played, from slow to fast. */
export const PLAYED_IN = [30, 12, 5, 2];

/** @param {{onChange: () => void, seconds?: number}} options */
export function createPlayback({ onChange, seconds = 5 }) {
  let [start, end, clock, playing] = [0, 0, 0, false];
  return {
    get clock() {
      return clock;
    },
    get end() {
      return end;
    },
    get start() {
      return start;
    },
    get playing() {
      return playing;
    },
    get done() {
      return clock >= end;
    },
    get seconds() {
      return seconds;
    },
    /** @param {number} value */
    setSeconds(value) {
      seconds = value;
    },
    /** @param {number} from @param {number} to @param {boolean} atOnce  shown whole, as for those who want no motion */
    load(from, to, atOnce) {
      [start, end, clock, playing] = [from, to, atOnce ? to : from, !atOnce];
      onChange();
    },
    play() {
      if (clock >= end) clock = start;
      playing = end > start;
      onChange();
    },
    pause() {
      playing = false;
      onChange();
    },
    /** @param {number} t */
    seek(t) {
      playing = false;
      clock = Math.min(end, Math.max(start, t));
      onChange();
    },
    /** @param {number} passed  seconds since the last tick */
    tick(passed) {
      if (!playing) return;
      clock = Math.min(end, clock + (passed * (end - start)) / seconds);
      if (clock < end) return;
      playing = false;
      onChange();
    },
  };
}
