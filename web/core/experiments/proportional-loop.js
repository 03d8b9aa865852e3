/**
 * A linear plant with dead time under proportional control, run on while the gain is moved: a knob under the hand
 * cannot wait for a server. Input and gain are as the server has them; u goes in straight lines over steps far
 * shorter than the period, the dead time is a whole number of them, and the step of the plant is exact.
 */

/** @typedef {ReturnType<typeof createProportionalLoop>} ProportionalLoop */
/** @typedef {{A: number[][], B: number[][], C: number[][], theta: number}} LinearPlant  without feedthrough */

/** @param {number[][]} M @param {number[][]} N */
function times(M, N) {
  return M.map((row) => (N[0] ?? []).map((_, j) => row.reduce((sum, m, k) => sum + m * (N[k]?.[j] ?? 0), 0)));
}

/** exp(M) by its series, halved until it converges at once. @param {number[][]} M */
export function exponential(M) {
  const size = Math.max(0, ...M.map((row) => row.reduce((sum, v) => sum + Math.abs(v), 0)));
  const halvings = Math.max(0, Math.ceil(Math.log2(size || 1)) + 1);
  const small = M.map((row) => row.map((v) => v / 2 ** halvings));
  let sum = M.map((row, i) => row.map((_, j) => Number(i === j)));
  let term = sum;
  for (let k = 1; k <= 18; k++) {
    term = times(term, small).map((row) => row.map((v) => v / k));
    sum = sum.map((row, i) => row.map((v, j) => v + (term[i]?.[j] ?? 0)));
  }
  for (let k = 0; k < halvings; k++) sum = times(sum, sum);
  return sum;
}

/**
 * @param {LinearPlant} plant
 * @param {{Kc: number, step: number, r?: number, low?: number | null, high?: number | null, noise?: () => number}} options
 *   step: about how long, the dead time makes it whole; r: the setpoint from t = 0 on
 */
export function createProportionalLoop({ A, B, C, theta }, { Kc, step, r = 1, low = null, high = null, noise = () => 0 }) {
  const n = A.length;
  const delay = theta > 0 ? Math.max(1, Math.ceil(theta / step)) : 0;
  const dt = delay ? theta / delay : step;
  // Rows of x, then u and its change over the step: exp gives what x, u and the change of u make of x.
  const whole = exponential([...A.map((row, i) => [...row.map((v) => v * dt), (B[i]?.[0] ?? 0) * dt, 0]), [...A.map(() => 0), 0, 1], Array(n + 2).fill(0)]);
  const Phi = whole.slice(0, n).map((row) => row.slice(0, n));
  const atEnd = whole.slice(0, n).map((row) => row[n + 1] ?? 0);
  const atStart = whole.slice(0, n).map((row, i) => (row[n] ?? 0) - (atEnd[i] ?? 0));
  const c = C[0] ?? [];
  const output = (/** @type {number[]} */ x) => c.reduce((sum, v, i) => sum + v * (x[i] ?? 0), 0);
  const held = (/** @type {number} */ u) => Math.min(high ?? Infinity, Math.max(low ?? -Infinity, u));

  /** @type {number[]} */
  let x = Array(n).fill(0);
  let gain = Kc;
  let wanted = Kc;
  let setpoint = r;
  let error = r - noise();
  const first = held(gain * error);
  const curves = { t: [0], r: [r], y: [0], u: [first], y_m: [r - error] };
  /** What is on its way to the plant: u just after each step begins, and just before it ends. @type {[number, number][]} */
  const pending = [];
  let right = first;
  let limited = -Infinity;

  function advance() {
    const now = curves.t.length * dt;
    if (wanted !== gain || setpoint !== r) {
      error += setpoint - r;
      [gain, r] = [wanted, setpoint];
      right = held(gain * error);
    }
    const n_k = noise();
    /** @type {[number, number]} */
    let given = [0, 0];
    if (delay) given = pending.length >= delay ? /** @type {[number, number]} */ (pending.shift()) : [0, 0];
    else {
      const [free, reach] = [x.map((_, i) => (Phi[i] ?? []).reduce((sum, p, j) => sum + p * (x[j] ?? 0), 0) + (atStart[i] ?? 0) * right), output(atEnd)];
      given = [right, held((gain * (r - output(free) - n_k)) / (1 + gain * reach))];
    }
    x = x.map((_, i) => (Phi[i] ?? []).reduce((sum, p, j) => sum + p * (x[j] ?? 0), 0) + (atStart[i] ?? 0) * given[0] + (atEnd[i] ?? 0) * given[1]);
    const y = output(x);
    error = r - y - n_k;
    const left = held(gain * error);
    if (left !== gain * error) limited = now;
    if (delay) pending.push([right, left]);
    right = left;
    curves.t.push(now);
    curves.r.push(r);
    curves.y.push(y);
    curves.y_m.push(y + n_k);
    curves.u.push(left);
  }

  return {
    curves,
    step: dt,
    get Kc() {
      return wanted;
    },
    set Kc(value) {
      wanted = value;
    },
    get r() {
      return setpoint;
    },
    set r(value) {
      setpoint = value;
    },
    get end() {
      return curves.t.at(-1) ?? 0;
    },
    /** When u was last at a limit. */
    get limited() {
      return limited;
    },
    /** Runs until `t`; false where the output has run away. @param {number} t @param {number} [most]  beyond this it has */
    until(t, most = 1e6) {
      while (this.end < t) {
        advance();
        if (!(Math.abs(curves.y.at(-1) ?? 0) < most)) return false;
      }
      return true;
    },
  };
}
