// @ts-check
/** Marks: points of the drawing, and where they belong on the wall. */

import { by, element } from './dom.js'
import { told } from './place.js'
import { Homography } from './sheet.js'
import { listed, plain } from './words.js'

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {import('./api.js').PlanFigures} PlanFigures
 * @typedef {import('./api.js').Points} Points
 * @typedef {import('./wall.js').Wall} Wall
 */

/** How near to an end, a corner or a line a point is that is meant there, pixels. */
const NEAR = 16
/** Less of a turn within some millimetres is no corner, rad; how long those are, m. */
const BEND = 0.5
const WAY_M = 2e-3
const NONE = 'Give a point of the drawing and where on the wall it belongs: one mark places the drawing, a second also turns and sizes it, and more check both.'

export class Marks {
  /** @param {Wall} wall @param {{ changed: (flags: Flags) => void, flags: () => Flags, ask: (words: string) => void }} hooks */
  constructor(wall, hooks) {
    this.wall = wall
    this.hooks = hooks
    /** @type {PlanFigures | null} */
    this.plan = null
    this.shown = ''
    /** @type {[number, number] | null} where a click would mark */
    this.near = null
    wall.above.push(this)
    by('add-mark').addEventListener('click', () => this.#add())
  }

  /** @returns {string[]} */
  #all() {
    return listed(this.hooks.flags().align)
  }

  /** Shows the marks that there are, and how well they fit as it was planned. @param {PlanFigures | null} plan */
  show(plan) {
    this.plan = plan
    const all = this.#all()
    this.wall.holds = all.length > 1
    by('marks-told').hidden = all.length === 0
    by('marks-words').textContent = all.length === 0 ? NONE : all.length === 1 ? 'It lies by this mark. A second one also turns and sizes it.' : this.#fit(all.length)
    const residual = plan?.align?.residual_mm ?? []
    if (this.shown === JSON.stringify(all)) {
      by('mark-list').querySelectorAll('small').forEach((small, n) => (small.textContent = off(residual[n], all.length)))
      return
    }
    this.shown = JSON.stringify(all)
    by('mark-list').replaceChildren(...all.map((mark, n) => this.#row(mark, n, off(residual[n], all.length))))
  }

  /** How well marks fit, in words. @param {number} count */
  #fit(count) {
    const align = this.plan?.align
    if (!align || align.residual_mm.length !== count) return ''
    return count < 3 ? 'Two marks place, turn and size it. A third would show whether one is wrong.' : `They are ${plain(align.rms_mm, 1)} mm off (rms); mark ${align.worst} is the worst.`
  }

  /** @param {string} mark @param {number} n @param {string} fits */
  #row(mark, n, fits) {
    const [at, to] = mark.split('=')
    const input = /** @type {HTMLInputElement} */ (element('input', { type: 'text', spellcheck: 'false', 'aria-label': `Where mark ${n + 1} belongs: right, up`, title: 'Right and up, such as 1.2m,0.4m; or the angles at which the head’s dot is on it, such as 12deg,-3deg', name: 'align' }))
    input.value = to ?? ''
    const change = (/** @type {string[]} */ next) => this.hooks.changed({ align: next })
    input.addEventListener('change', () => change(this.#all().map((old, k) => (k === n ? `${at}=${input.value.trim()}` : old))))
    const away = element('button', { type: 'button', class: 'drop', text: '×', title: 'Take it away', 'aria-label': `Take mark ${n + 1} away` })
    away.addEventListener('click', () => change(this.#all().filter((_, k) => k !== n)))
    const name = element('span', { text: `${n + 1}`, class: 'pin', title: `At ${at} of the drawing` })
    return element('li', { class: 'listed' }, name, input, away, element('small', { text: fits }))
  }

  /** Asks for a point of the drawing. */
  #add() {
    const { wall } = this
    if (!this.plan?.sheet || !wall.points) return
    this.hooks.ask('Click a point of the drawing: an end, a corner, a line.')
    const show = (/** @type {[number, number]} */ at) => {
      this.near = snapped(wall, at)
    }
    wall.ask({
      from: show,
      to: show,
      done: (at) => {
        const sheet = this.plan?.sheet
        // what is planned anew just now lies elsewhere in a moment
        if (!sheet || !wall.isPlanned()) return this.hooks.ask('It is being planned: click again in a moment.')
        const point = snapped(wall, at)
        this.#over()
        const [x, y] = new Homography(sheet.target_m, sheet.corners).apply(point)
        const place = sheet.unit === 'px' ? `${plain(x, 2)}px,${plain(y, 2)}px` : `${plain(1e3 * x, 2)}mm,${plain(1e3 * y, 2)}mm`
        const flags = this.hooks.flags()
        const all = [...this.#all(), `${place}=${told(point, flags)}`]
        // what marks tell is not asked for beside them
        this.hooks.changed({ align: all, offset: '', ...(all.length > 1 ? { rotate: '', width: '', height: '' } : {}) })
        // where it belongs is typed next
        const typed = /** @type {HTMLInputElement | null} */ (by('mark-list').querySelector('li:last-child input'))
        typed?.focus()
        typed?.select()
      },
      cancelled: () => this.#over(),
    })
  }

  #over() {
    this.near = null
    this.wall.ask(null)
    this.hooks.ask('')
  }

  /** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {import('./paint.js').Colours} colours */
  draw(context, wall, colours) {
    if (this.near) ring(context, wall.toPixels(this.near), colours.light)
    const sheet = this.plan?.sheet
    if (!sheet || wall.fixed) return
    const lies = new Homography(sheet.corners, sheet.target_m)
    this.#all().forEach((mark, n) => {
      const [x, y] = mark.split('=')[0].split(',').map((text) => Number.parseFloat(text) * (sheet.unit === 'px' ? 1 : unit(text)))
      if (Number.isFinite(x + y)) pin(context, wall.toPixels(wall.carried(lies.apply([x, y]))), `${n + 1}`, colours)
    })
  }
}

/** Metres of a length's unit. @param {string} text */
const unit = (text) => ({ mm: 1e-3, cm: 1e-2, in: 0.0254, ft: 0.3048 })[/[a-z]+$/.exec(text.trim())?.[0] ?? 'm'] ?? 1

/** How far off a mark is, in words; nothing where nothing checks it. @param {number | undefined} mm @param {number} count */
const off = (mm, count) => (mm === undefined || count < 3 ? '' : `${plain(mm, 1)} mm off`)

/** @param {CanvasRenderingContext2D} context @param {[number, number]} at @param {string} colour */
function ring(context, [x, y], colour) {
  context.strokeStyle = colour
  context.lineWidth = 2
  context.beginPath()
  context.arc(x, y, 9, 0, 2 * Math.PI)
  context.moveTo(x - 14, y)
  context.lineTo(x + 14, y)
  context.moveTo(x, y - 14)
  context.lineTo(x, y + 14)
  context.stroke()
}

/** @param {CanvasRenderingContext2D} context @param {[number, number]} at @param {string} name @param {import('./paint.js').Colours} colours */
function pin(context, [x, y], name, colours) {
  context.fillStyle = colours.accent
  context.beginPath()
  context.moveTo(x, y)
  context.lineTo(x - 7, y - 14)
  context.lineTo(x + 7, y - 14)
  context.fill()
  context.beginPath()
  context.arc(x, y - 20, 11, 0, 2 * Math.PI)
  context.fill()
  context.fillStyle = colours.on
  context.font = '700 12px system-ui, sans-serif'
  context.textAlign = 'center'
  context.textBaseline = 'middle'
  context.fillText(name, x, y - 20)
}

/** The end, corner or line of the plan that is meant by a place. @param {Wall} wall @param {[number, number]} at @returns {[number, number]} */
function snapped({ points, view }, [x, y]) {
  if (!points) return [x, y]
  const reach = NEAR / view.scale
  let [best, row] = [Infinity, -1]
  for (let n = 0; n < points.rows; n++) {
    if (points.lit[n] === 0) continue
    const far = Math.hypot(points.x[n] - x, points.y[n] - y)
    if (far > reach) continue
    // an end or a corner before what lies on a line, however near that is
    const order = far - reach * special(points, n)
    if (order < best) [best, row] = [order, n]
  }
  return row < 0 ? [x, y] : [points.x[row], points.y[row]]
}

/** How special a row of a plan is: 1 where a stroke ends or bends by a right angle and more, 0 where it goes straight on. @param {Points} points @param {number} row */
function special(points, row) {
  const along = (/** @type {1 | -1} */ way) => {
    let n = row
    while (points.lit[n + way] > 0 && points.stroke[n + way] === points.stroke[row] && Math.hypot(points.x[n] - points.x[row], points.y[n] - points.y[row]) < WAY_M) n += way
    return n
  }
  const [before, after] = [along(-1), along(1)]
  if (before === row || after === row) return 1
  const [bx, by, ax, ay] = [points.x[row] - points.x[before], points.y[row] - points.y[before], points.x[after] - points.x[row], points.y[after] - points.y[row]]
  const turns = Math.abs(Math.atan2(bx * ay - by * ax, bx * ax + by * ay))
  return turns < BEND ? 0 : Math.min(1, turns / (Math.PI / 2))
}
