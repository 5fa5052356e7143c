/**
 * Positions of a subject that streams orientations alone, moved aside by `aside` metres along Y so that several such
 * subjects do not stand in each other.
 */
export function inPlace(position: Float32Array, aside: number): Float32Array {
  return position.map((value, at) => (at % 3 === 1 ? value + aside : value));
}
