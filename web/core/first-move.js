/** Which way an output goes at first when its input rises. */

/**
 * The first of CB, CAB, CA²B ... that is not zero; 0 where the input does not move the output.
 * @param {number[][]} A @param {number[][]} B @param {number[][]} C
 */
export function firstMove(A, B, C) {
  let x = B.map((row) => row[0] ?? 0);
  for (let k = 0; k < Math.max(1, A.length); k++) {
    const markov = (C[0] ?? []).reduce((sum, c, i) => sum + c * (x[i] ?? 0), 0);
    const size = (C[0] ?? []).reduce((sum, c, i) => sum + Math.abs(c * (x[i] ?? 0)), 0);
    if (Math.abs(markov) > 1e-9 * size) return Math.sign(markov);
    x = A.map((row) => row.reduce((sum, a, i) => sum + a * (x[i] ?? 0), 0));
  }
  return 0;
}
