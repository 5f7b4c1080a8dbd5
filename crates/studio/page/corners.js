// @ts-check
/** The four corners of a sheet of paper, shown on its photograph. */

import { by } from './dom.js'
import { Homography } from './sheet.js'
import { plain } from './words.js'

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {import('./api.js').Sheet} Sheet
 * @typedef {import('./wall.js').Wall} Wall
 */

const WHICH = ['left upper', 'right upper', 'right lower', 'left lower']

export class Corners {
  /** @param {Wall} wall @param {{ changed: (flags: Flags) => void, ask: (words: string) => void }} hooks @param {() => Sheet | null} sheet as it was planned */
  constructor(wall, hooks, sheet) {
    this.wall = wall
    this.hooks = hooks
    /** @type {[number, number][]} those that were shown, m */
    this.corners = []
    wall.above.push(this)
    by('show-corners').addEventListener('click', () => {
      if (sheet()?.unit === 'px') this.#ask(sheet)
      else wall.cancel()
    })
  }

  /** @param {() => Sheet | null} planned */
  #ask(planned) {
    const range = /** @type {HTMLInputElement} */ (by('beneath'))
    // corners are shown on the picture
    if (Number(range.value) < 60) range.value = '60'
    this.corners = []
    const next = () => this.hooks.ask(`Click the paper’s ${WHICH[this.corners.length]} corner.`)
    next()
    this.wall.ask({
      from: () => {},
      to: () => {},
      done: (at) => {
        const sheet = planned()
        // what is planned anew just now lies elsewhere in a moment
        if (!sheet || !this.wall.isPlanned()) return this.hooks.ask('It is being planned: click again in a moment.')
        this.corners.push(at)
        if (this.corners.length < WHICH.length) return next()
        const lies = new Homography(sheet.target_m, sheet.corners)
        const pixels = this.corners.map((corner) => lies.apply(corner).map((n) => plain(n, 1)).join(','))
        this.#over()
        this.hooks.changed({ straighten: pixels.join(' '), whole: false })
      },
      cancelled: () => this.#over(),
    })
  }

  #over() {
    this.corners = []
    this.wall.ask(null)
    this.hooks.ask('')
  }

  /** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {import('./paint.js').Colours} colours */
  draw(context, wall, colours) {
    if (this.corners.length === 0) return
    context.strokeStyle = colours.light
    context.lineWidth = 2
    context.beginPath()
    const pixels = this.corners.map((corner) => wall.toPixels(corner))
    for (const at of pixels) context.lineTo(...at)
    for (const [x, y] of pixels) {
      context.moveTo(x + 6, y)
      context.arc(x, y, 6, 0, 2 * Math.PI)
    }
    context.stroke()
  }
}
