/** Packed arrays of an answer, `{"dtype": "f4", "bdata": base64}`, turned into typed arrays. */

const ARRAY_OF = { f4: Float32Array, f8: Float64Array };

/**
 * @param {{dtype: "f4" | "f8", bdata: string}} packed
 * @returns {Float32Array | Float64Array}
 */
export function decodeArray({ dtype, bdata }) {
  const text = atob(bdata);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return new ARRAY_OF[dtype](bytes.buffer);
}

/**
 * The same value with every packed array in it unpacked, in place.
 * @param {any} value
 * @returns {any}
 */
export function decodeArrays(value) {
  if (value === null || typeof value !== "object" || typeof value[0] === "number") return value;
  if (typeof value.bdata === "string" && value.dtype in ARRAY_OF) return decodeArray(value);
  for (const key of Object.keys(value)) value[key] = decodeArrays(value[key]);
  return value;
}
