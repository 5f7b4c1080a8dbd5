// @ts-check
/** A plan as it is painted: its colours, its lines, and what of it is lit until a moment. */

/**
 * @typedef {import('./api.js').Points} Points
 * @typedef {import('./wall.js').Box} Box
 * @typedef {import('./wall.js').View} View
 */

/** What is lit until a moment: only what is new is drawn. */
export class Lit {
  constructor() {
    this.canvas = document.createElement('canvas')
    /** What is drawn already, and for which view. */
    this.tick = 0
    this.of = ''
    /** The row at which a job began: what is before it was left out. */
    this.begins = 0
  }

  /** Nothing before a row is lit. @param {number} row */
  from(row) {
    if (row === this.begins) return
    this.begins = row
    this.forget()
  }

  forget() {
    this.tick = 0
    this.of = ''
  }

  /**
   * @param {number} tick @param {Points} points @param {View} view @param {HTMLCanvasElement} wall @param {number} ratio @param {Colours} colours
   */
  until(tick, points, view, wall, ratio, colours) {
    const of = `${view.x},${view.y},${view.scale},${wall.width},${wall.height}`
    const context = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext('2d'))
    if (of !== this.of || tick < this.tick) {
      this.canvas.width = wall.width
      this.canvas.height = wall.height
      this.tick = 0
      this.of = of
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    context.strokeStyle = colours.light
    context.lineWidth = 2
    context.lineCap = 'round'
    context.beginPath()
    const px = (/** @type {number} */ n) => wall.clientWidth / 2 + (points.x[n] - view.x) * view.scale
    const py = (/** @type {number} */ n) => wall.clientHeight / 2 - (points.y[n] - view.y) * view.scale
    const last = Math.min(tick, points.rows - 1)
    for (let n = Math.max(this.tick, this.begins); n < last; n++) {
      if (points.lit[n] === 0) continue
      if (n === this.tick || n === this.begins || points.lit[n - 1] === 0) context.moveTo(px(n), py(n))
      context.lineTo(px(n + 1), py(n + 1))
    }
    context.stroke()
    this.tick = last
    return this.canvas
  }
}

/**
 * @typedef {{ wall: string, card: string, grid: string, rule: string, soft: string, light: string, accent: string, dark: string, warn: string, on: string, from: string, to: string }} Colours
 * @param {Element} element @returns {Colours}
 */
export function coloursOf(element) {
  const style = getComputedStyle(element)
  const value = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim()
  return {
    wall: value('wall'),
    card: value('card'),
    grid: value('grid'),
    rule: value('rule'),
    soft: value('soft'),
    light: value('light'),
    accent: value('accent'),
    dark: value('dark'),
    warn: value('warn'),
    on: value('on-accent'),
    from: value('first'),
    to: value('last'),
  }
}

/** The plan from its middle, y down: dark ways thin, lit ones in the colours of their order. @param {CanvasRenderingContext2D} context @param {Points} points @param {Box} box @param {number} scale @param {number} ratio @param {Colours} colours */
export function drawPlan(context, points, box, scale, ratio, colours) {
  const step = Math.max(0.4 / scale, 1e-6)
  const count = points.stroke.reduce((most, number) => Math.max(most, number), 1)
  const at = (/** @type {number} */ n) => /** @type {[number, number]} */ ([(points.x[n] - box.x) * scale, -(points.y[n] - box.y) * scale])
  context.lineCap = 'round'
  context.lineJoin = 'round'
  let from = 0
  while (from < points.rows - 1) {
    const lit = points.lit[from] > 0
    let end = from
    context.beginPath()
    context.moveTo(...at(from))
    let [last_x, last_y] = [points.x[from], points.y[from]]
    while (end < points.rows - 1 && points.lit[end] > 0 === lit) {
      end++
      const ends = end === points.rows - 1 || points.lit[end] > 0 !== lit
      if (ends || Math.hypot(points.x[end] - last_x, points.y[end] - last_y) >= step) {
        context.lineTo(...at(end))
        last_x = points.x[end]
        last_y = points.y[end]
      }
    }
    context.setLineDash(lit ? [] : [2 * ratio, 4 * ratio])
    context.lineWidth = (lit ? 2 : 1) * ratio
    context.strokeStyle = lit ? `color-mix(in oklab, ${colours.from}, ${colours.to} ${Math.round((100 * points.stroke[from]) / count)}%)` : colours.dark
    context.stroke()
    from = end
  }
}

/** Left, top, right, low of what is planned, from its middle, m, y down. @param {Points} points @param {Box} box */
export function boundsOf(points, box) {
  const all = [Infinity, Infinity, -Infinity, -Infinity]
  for (let n = 0; n < points.rows; n++) {
    const [x, y] = [points.x[n] - box.x, box.y - points.y[n]]
    all[0] = Math.min(all[0], x)
    all[1] = Math.min(all[1], y)
    all[2] = Math.max(all[2], x)
    all[3] = Math.max(all[3], y)
  }
  return all
}

/** The next of 1, 2, 5, 10, 20 … @param {number} least */
export function tidy(least) {
  const ten = 10 ** Math.floor(Math.log10(least))
  return ten * (least / ten <= 1 ? 1 : least / ten <= 2 ? 2 : least / ten <= 5 ? 5 : 10)
}
