// @ts-check
/** From places of a drawing, as its file names them, to the wall and back. */

/** @typedef {[number, number]} Place */

/** A map of a plane that keeps straight lines straight, by four places and where they go. */
export class Homography {
  /** @param {Place[]} from @param {Place[]} to */
  constructor(from, to) {
    /** @type {number[][]} */
    const rows = []
    from.forEach(([x, y], n) => {
      const [u, v] = to[n]
      rows.push([x, y, 1, 0, 0, 0, -u * x, -u * y, u], [0, 0, 0, x, y, 1, -v * x, -v * y, v])
    })
    this.of = solved(rows)
    this.side = Math.sign(this.#depth(from[0]))
  }

  /** @param {Place} at */
  #depth([x, y]) {
    return this.of[6] * x + this.of[7] * y + 1
  }

  /** Whether a place is on this side of the horizon, as those are by which it was found. @param {Place} at */
  isInFront(at) {
    return this.#depth(at) * this.side > 1e-9
  }

  /** @param {Place} at @returns {Place} */
  apply([x, y]) {
    const [a, b, c, d, e, f] = this.of
    const w = this.#depth([x, y])
    return [(a * x + b * y + c) / w, (d * x + e * y + f) / w]
  }

  /** Whether parallels stay parallels, as far as a picture of that size shows. @param {number} size */
  isAffine(size) {
    return Math.hypot(this.of[6], this.of[7]) * size < 1e-6
  }
}

/** Solves as many equations as there are unknowns; each row ends with its right side. @param {number[][]} rows @returns {number[]} */
function solved(rows) {
  const count = rows.length
  for (let column = 0; column < count; column++) {
    let best = column
    for (let row = column; row < count; row++) if (Math.abs(rows[row][column]) > Math.abs(rows[best][column])) best = row
    ;[rows[column], rows[best]] = [rows[best], rows[column]]
    for (let row = 0; row < count; row++) {
      if (row === column) continue
      const by = rows[row][column] / rows[column][column]
      for (let n = column; n <= count; n++) rows[row][n] -= by * rows[column][n]
    }
  }
  return rows.map((row, n) => row[count] / row[n])
}
