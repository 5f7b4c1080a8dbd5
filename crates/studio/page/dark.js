// @ts-check
/** Areas of the wall that are never lit: listed, drawn, and shown hatched. */

import { by, element } from './dom.js'
import { areaOf } from './place.js'
import { length, listed } from './words.js'

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {import('./wall.js').Wall} Wall
 */

/** A smaller area was not meant, pixels; between two lines of a hatch. */
const LEAST = 6
const HATCH = 9

export class Dark {
  /** @param {Wall} wall @param {{ changed: (flags: Flags) => void, flags: () => Flags, ask: (words: string) => void }} hooks */
  constructor(wall, hooks) {
    this.wall = wall
    this.hooks = hooks
    /** @type {[number, number][][]} outlines of what is dark as it was planned, m */
    this.outlines = []
    /** @type {[[number, number], [number, number]] | null} two corners of one that is drawn just now, m */
    this.drawn = null
    this.shown = ''
    wall.above.push(this)
    by('add-dark').addEventListener('click', () => this.#add())
    by('add-layer').addEventListener('click', () => this.#change([...this.#all(), '10cm,10cm,20cm,20cm']))
  }

  #all() {
    return listed(this.hooks.flags().no_go)
  }

  /** @param {string[]} all */
  #change(all) {
    this.hooks.changed({ no_go: all })
  }

  /** Shows what is never lit, as it was planned. @param {import('./api.js').PlanFigures | null} plan */
  show(plan) {
    this.outlines = plan?.no_go?.outlines_m ?? []
    const all = this.#all()
    const summary = /** @type {HTMLElement} */ (by('dark').querySelector('summary'))
    summary.textContent = all.length === 0 ? 'Never lit' : `Never lit (${all.length})${plan?.no_go?.length_m ? `: ${length(plan.no_go.length_m)} of lines left out` : ''}`
    if (this.shown === JSON.stringify(all)) return
    this.shown = JSON.stringify(all)
    by('dark-list').replaceChildren(
      ...all.map((area, n) => {
        const input = /** @type {HTMLInputElement} */ (element('input', { type: 'text', spellcheck: 'false', name: 'no_go', 'aria-label': `Area ${n + 1}: right, up, width, height; or a layer`, title: 'Right, up, width, height, such as 10cm,20cm,8cm,8cm; or the name of a layer whose closed lines it is' }))
        input.value = area
        input.addEventListener('change', () => this.#change(this.#all().map((old, k) => (k === n ? input.value.trim() : old)).filter((value) => value !== '')))
        const away = element('button', { type: 'button', class: 'drop', text: '×', title: 'Take it away', 'aria-label': `Take area ${n + 1} away` })
        away.addEventListener('click', () => this.#change(this.#all().filter((_, k) => k !== n)))
        return element('li', { class: 'listed' }, element('span', { text: '▨' }), input, away)
      }),
    )
  }

  /** Asks for an area on the wall. */
  #add() {
    const { wall } = this
    this.hooks.ask('Drag over what must never be lit.')
    wall.ask({
      from: (at) => {
        this.drawn = [at, at]
      },
      to: (at) => {
        if (this.drawn) this.drawn[1] = at
      },
      done: (at) => {
        const from = this.drawn?.[0] ?? at
        this.#over()
        const [left, right] = [Math.min(from[0], at[0]), Math.max(from[0], at[0])]
        const [low, top] = [Math.min(from[1], at[1]), Math.max(from[1], at[1])]
        if (Math.min(right - left, top - low) * wall.view.scale < LEAST) return
        this.#change([...this.#all(), areaOf([left, low, right, top], this.hooks.flags())])
      },
      cancelled: () => this.#over(),
    })
  }

  #over() {
    this.drawn = null
    this.wall.ask(null)
    this.hooks.ask('')
  }

  /** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {import('./paint.js').Colours} colours */
  draw(context, wall, colours) {
    const [[ax, ay], [bx, by]] = this.drawn ?? [[0, 0], [0, 0]]
    /** @type {[number, number][][]} */
    const drawn = this.drawn ? [[[ax, ay], [bx, ay], [bx, by], [ax, by]]] : []
    for (const outline of [...this.outlines, ...drawn]) hatched(context, outline.map((at) => wall.toPixels(at)), wall.canvas, colours.warn)
  }
}

/** @param {CanvasRenderingContext2D} context @param {[number, number][]} outline pixels @param {HTMLCanvasElement} canvas @param {string} colour */
function hatched(context, outline, canvas, colour) {
  const within = (/** @type {number} */ value, /** @type {number} */ most) => Math.min(most, Math.max(0, value))
  const [xs, ys] = [outline.map(([x]) => within(x, canvas.clientWidth)), outline.map(([, y]) => within(y, canvas.clientHeight))]
  const [left, right, top, low] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)]
  context.save()
  context.strokeStyle = colour
  context.lineWidth = 1.5
  context.beginPath()
  for (const at of outline) context.lineTo(...at)
  context.closePath()
  context.stroke()
  context.clip()
  context.globalAlpha = 0.6
  context.lineWidth = 1
  context.beginPath()
  const high = low - top
  for (let x = Math.floor((left - high) / HATCH) * HATCH; x < right; x += HATCH) {
    context.moveTo(x, low)
    context.lineTo(x + high, top)
  }
  context.stroke()
  context.restore()
}
