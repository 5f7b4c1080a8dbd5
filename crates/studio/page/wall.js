// @ts-check
/** The wall in true size: rulers, the drawing, its handles. The drawing is drawn once for each zoom, and that picture is moved while somebody drags it. */

import { Lit, boundsOf, coloursOf, drawPlan } from './paint.js'
import { RULER, drawGrid, drawRulers } from './scale.js'
import { length } from './words.js'

/**
 * @typedef {import('./api.js').Points} Points
 * @typedef {import('./paint.js').Colours} Colours
 * @typedef {{ x: number, y: number, turn: number, width: number, height: number }} Box where the picture lies: its middle and size, m, y up; its turn, rad, anticlockwise
 * @typedef {{ draw: (context: CanvasRenderingContext2D, wall: Wall, colours: Colours) => void }} Layer what lies under the drawing, or over it
 * @typedef {{ from: (at: [number, number]) => void, to: (at: [number, number]) => void, done: (at: [number, number]) => void, cancelled: () => void }} Tool what is shown on the wall by a pointer, m: where it begins, goes, and ends
 * @typedef {{ x: number, y: number, scale: number }} View what is seen: the point in the middle, m, and pixels a metre
 */

/** Pixels around the drawing when all is shown; of a handle. */
const MARGIN = 64
const HANDLE = 7
/** Boxes that differ by less lie at the same place, m. */
const SPAN_M = 5e-4
/** Where nothing is planned yet. @type {Box} */
export const NOWHERE = { x: 0, y: 0, turn: 0, width: 0.6096, height: 0.4572 }
/** Largest picture of the drawing, pixels either way. */
const MOST_PIXELS = 4096
/** Ends of a stroke that is closed are nearer than this, m. */
const CLOSED_M = 2e-3
/** The longest way of a pointer that is a click and no drag, pixels. */
const CLICK = 3

export class Wall {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(box: Box, done: boolean) => void} moved when somebody has dragged it, and while
   */
  constructor(canvas, moved) {
    this.canvas = canvas
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'))
    this.moved = moved
    /** @type {Points | null} */
    this.points = null
    /** @type {Box} where it was planned */
    this.planned = NOWHERE
    /** @type {Box} where it is to be */
    this.box = { ...this.planned }
    /** @type {View} */
    this.view = { x: 0, y: 0, scale: 600 }
    this.tick = -1
    /** @type {number[] | null} */
    this.bounds = null
    /** @type {{ image: HTMLCanvasElement, left: number, top: number, scale: number } | null} */
    this.bitmap = null
    /** @type {{ kind: string, from: [number, number], box: Box, view: View, far: boolean } | null} */
    this.drag = null
    /** @type {Map<number, [number, number]>} */
    this.fingers = new Map()
    this.lit = new Lit()
    this.dirty = true
    this.first = true
    /** Whether all of the drawing is shown: nobody has looked closer since. */
    this.fitted = true
    /** Whether the drawing stays where it is: it is being drawn there. */
    this.fixed = false
    /** Whether the spot is known to be dark, wherever the plan has it. */
    this.dark = false
    /** @type {[number, number] | null} a place that is marked, m */
    this.mark = null
    /** @type {Layer[]} */
    this.beneath = []
    /** @type {Layer[]} */
    this.above = []
    /** @type {Tool | null} what a pointer shows now, instead of moving anything */
    this.tool = null
    /** Whether its place alone is free: marks tell its turn and its size. */
    this.holds = false
    new ResizeObserver(() => this.#resized()).observe(canvas)
    this.#listen()
    const frame = () => {
      if (this.dirty) this.#draw()
      requestAnimationFrame(frame)
    }
    requestAnimationFrame(frame)
  }

  /** Takes a plan, or none. @param {Points | null} points @param {Box} box */
  show(points, box) {
    // who has looked closer goes on looking there
    const fits = this.points === null || this.fitted || this.#isSeen(this.planned)
    this.points = points
    this.planned = { ...box }
    this.bounds = points ? boundsOf(points, this.planned) : null
    if (!this.drag) this.box = { ...box }
    this.redraw()
    if (this.first || (fits && !this.#isSeen(this.box))) this.fit()
    this.first = false
  }

  /** Where it is to be, until it is planned there. @param {Box} box */
  place(box) {
    if (this.drag) return
    this.box = { ...box }
    this.dirty = true
  }

  /** The moment that is shown, a row of the plan; −1 for all of it. @param {number} tick */
  at(tick) {
    this.tick = tick
    this.dirty = true
  }

  redraw() {
    this.bitmap = null
    this.lit.forget()
    this.dirty = true
  }

  /** @param {number} factor @param {[number, number]} [about] pixels */
  zoom(factor, about) {
    this.fitted = false
    const [px, py] = about ?? [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2]
    const [x, y] = this.toPlace([px, py])
    this.view.scale = Math.min(1e5, Math.max(5, this.view.scale * factor))
    const [after_x, after_y] = this.toPlace([px, py])
    this.view.x += x - after_x
    this.view.y += y - after_y
    this.dirty = true
  }

  /** Shows all of the drawing. */
  fit() {
    const { clientWidth: wide, clientHeight: high } = this.canvas
    const corners = this.#corners(this.box)
    const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)]
    const [left, right, low, top] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)]
    // what is drawn has no handles around it
    const margin = Math.min(MARGIN, 0.1 * wide, this.fixed ? 0.06 * high : MARGIN)
    const room = (/** @type {number} */ pixels) => Math.max(40, pixels - 2 * margin - RULER)
    this.view.scale = Math.min(room(wide) / (right - left), room(high) / (top - low))
    this.view.x = (left + right) / 2 - RULER / 2 / this.view.scale
    this.view.y = (low + top) / 2 + RULER / 2 / this.view.scale
    this.fitted = true
    this.dirty = true
  }

  /** Whether all of the drawing is in view, and not small in it. @param {Box} box */
  #isSeen(box) {
    const { clientWidth: wide, clientHeight: high } = this.canvas
    const corners = this.#corners(box).map((corner) => this.toPixels(corner))
    const inside = corners.every(([x, y]) => x >= RULER && x <= wide && y >= RULER && y <= high)
    return inside && box.width * this.view.scale > 0.1 * wide
  }

  #resized() {
    if (this.canvas.clientWidth === 0) return
    const fits = this.points === null || this.fitted || this.#isSeen(this.box)
    this.#sharpen()
    // who has looked closer goes on looking there
    if (fits) this.fit()
    this.dirty = true
  }

  /** Gives the canvas a pixel for each of the screen's; another screen has others. */
  #sharpen() {
    const ratio = window.devicePixelRatio || 1
    const [wide, high] = [Math.round(this.canvas.clientWidth * ratio), Math.round(this.canvas.clientHeight * ratio)]
    if (this.canvas.width === wide && this.canvas.height === high) return
    this.canvas.width = wide
    this.canvas.height = high
  }

  /** Pixels of a place. @param {[number, number]} at @returns {[number, number]} */
  toPixels([x, y]) {
    const { scale } = this.view
    return [this.canvas.clientWidth / 2 + (x - this.view.x) * scale, this.canvas.clientHeight / 2 - (y - this.view.y) * scale]
  }

  /** The place at a pixel. @param {[number, number]} at @returns {[number, number]} */
  toPlace([px, py]) {
    const { scale } = this.view
    return [this.view.x + (px - this.canvas.clientWidth / 2) / scale, this.view.y - (py - this.canvas.clientHeight / 2) / scale]
  }

  /** The corners of a box, from its left top one clockwise, and the place of its ring. @param {Box} box @returns {[number, number][]} */
  #corners(box) {
    const [cos, sin] = [Math.cos(box.turn), Math.sin(box.turn)]
    const at = (/** @type {number} */ x, /** @type {number} */ y) =>
      /** @type {[number, number]} */ ([box.x + x * cos - y * sin, box.y + x * sin + y * cos])
    const [w, h] = [box.width / 2, box.height / 2]
    return [at(-w, h), at(w, h), at(w, -h), at(-w, -h)]
  }

  /** @returns {[number, number]} pixels of the ring by which it is turned */
  #ring() {
    const [[ax, ay], [bx, by]] = this.#corners(this.box).map((corner) => this.toPixels(corner))
    const [mx, my] = [(ax + bx) / 2, (ay + by) / 2]
    const [sin, cos] = [Math.sin(this.box.turn), Math.cos(this.box.turn)]
    return [mx - 26 * sin, my - 26 * cos]
  }

  #draw() {
    this.dirty = false
    // another view is shown
    if (this.canvas.clientWidth === 0) return
    this.#sharpen()
    const { context, canvas } = this
    const ratio = window.devicePixelRatio || 1
    const colours = coloursOf(canvas)
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight)
    drawGrid(context, this, colours)
    for (const layer of this.beneath) layer.draw(context, this, colours)
    if (this.points) {
      const still = this.drag === null && same(this.box, this.planned)
      if (!this.bitmap || (this.drag === null && off(this.bitmap.scale, this.#scale()))) this.#paint(colours)
      context.save()
      this.#carry(context)
      if (this.bitmap) {
        const { image, left, top, scale } = this.bitmap
        context.globalAlpha = this.tick >= 0 && still ? 0.28 : 1
        context.drawImage(image, left, top, image.width / scale, image.height / scale)
        context.globalAlpha = 1
      }
      context.restore()
      if (this.tick >= 0 && still) this.#light(colours)
    }
    if (this.points && !this.fixed) this.#handles(colours)
    for (const layer of this.above) layer.draw(context, this, colours)
    if (this.mark) this.#cross(this.mark, colours)
    drawRulers(context, this, colours)
  }

  /** Puts what was planned where it is to be: from then on one is a metre, y down, from the middle of what was planned. @param {CanvasRenderingContext2D} context */
  #carry(context) {
    const [px, py] = this.toPixels([this.box.x, this.box.y])
    const by = this.box.width / this.planned.width
    context.translate(px, py)
    context.rotate(this.planned.turn - this.box.turn)
    context.scale(this.view.scale * by, this.view.scale * by)
  }

  /** Draws the plan anew, as it was planned, for this zoom. @param {Colours} colours */
  #paint(colours) {
    const points = /** @type {Points} */ (this.points)
    const ratio = window.devicePixelRatio || 1
    const [left, top, right, low] = this.bounds ?? boundsOf(points, this.planned)
    const scale = this.#scale()
    const image = document.createElement('canvas')
    const pad = 3
    image.width = Math.ceil((right - left) * scale) + 2 * pad
    image.height = Math.ceil((low - top) * scale) + 2 * pad
    const context = /** @type {CanvasRenderingContext2D} */ (image.getContext('2d'))
    context.translate(pad - left * scale, pad - top * scale)
    drawPlan(context, points, this.planned, scale, ratio, colours)
    this.bitmap = { image, left: left - pad / scale, top: top - pad / scale, scale }
  }

  /** Pixels a metre of the picture of the plan: as this zoom has them, as far as it fits. */
  #scale() {
    const [left, top, right, low] = this.bounds ?? [0, 0, 1, 1]
    return Math.min(this.view.scale * (window.devicePixelRatio || 1), MOST_PIXELS / Math.max(right - left, low - top, 1e-6))
  }

  /** What is drawn until now, and the spot. @param {Colours} colours */
  #light(colours) {
    const points = /** @type {Points} */ (this.points)
    const ratio = window.devicePixelRatio || 1
    const seen = this.lit.until(this.tick, points, this.view, this.canvas, ratio, colours)
    this.context.drawImage(seen, 0, 0, this.canvas.clientWidth, this.canvas.clientHeight)
    const tick = Math.min(this.tick, points.rows - 1)
    const [x, y] = this.toPixels([points.x[tick], points.y[tick]])
    const is_lit = points.lit[tick] > 0 && !this.dark
    this.context.beginPath()
    this.context.arc(x, y, is_lit ? 5 : 3.5, 0, 2 * Math.PI)
    this.context.fillStyle = is_lit ? colours.light : colours.wall
    this.context.strokeStyle = is_lit ? colours.light : colours.soft
    this.context.lineWidth = 1.5
    this.context.fill()
    this.context.stroke()
    if (is_lit) {
      this.context.beginPath()
      this.context.arc(x, y, 11, 0, 2 * Math.PI)
      this.context.globalAlpha = 0.25
      this.context.fill()
      this.context.globalAlpha = 1
    }
  }

  /** A place that the head marks. @param {[number, number]} at @param {Colours} colours */
  #cross(at, colours) {
    const [x, y] = this.toPixels(at)
    const { context } = this
    context.strokeStyle = colours.light
    context.lineWidth = 3
    context.beginPath()
    for (const [dx, dy] of [[16, 0], [0, 16]]) {
      context.moveTo(x - dx, y - dy)
      context.lineTo(x + dx, y + dy)
    }
    context.moveTo(x + 24, y)
    context.arc(x, y, 24, 0, 2 * Math.PI)
    context.stroke()
  }

  /** Marks a place, or none. @param {[number, number] | null} at */
  marks(at) {
    this.mark = at
    this.dirty = true
  }

  /** Shows the drawing up to a place within a stroke, which is drawn there and back where it is open. @param {number} number from 1 @param {number} share of the way there, or there and back @param {boolean} lit */
  within(number, share, lit) {
    const { points } = this
    if (!points) return
    let first = 0
    while (first < points.rows - 1 && !(points.lit[first] > 0 && points.stroke[first] === number)) first++
    let last = first
    while (last < points.rows - 1 && !(points.lit[last + 1] > 0 && points.stroke[last + 1] > number)) last++
    while (last > first && !(points.lit[last] > 0)) last--
    const is_closed = Math.hypot(points.x[first] - points.x[last], points.y[first] - points.y[last]) < CLOSED_M
    const along = is_closed ? share : 1 - Math.abs(2 * share - 1)
    this.dark = !lit
    this.at(first + Math.round(Math.min(1, Math.max(0, along)) * (last - first)))
  }

  /** @param {Colours} colours */
  #handles(colours) {
    const { context } = this
    const corners = this.#corners(this.box).map((corner) => this.toPixels(corner))
    context.strokeStyle = colours.accent
    context.fillStyle = colours.card
    context.lineWidth = 1.25
    context.setLineDash([5, 4])
    context.beginPath()
    corners.forEach(([x, y], n) => (n === 0 ? context.moveTo(x, y) : context.lineTo(x, y)))
    context.closePath()
    context.stroke()
    context.setLineDash([])
    if (!this.holds) this.#grips(corners)
    context.fillStyle = colours.soft
    context.font = '12px system-ui, sans-serif'
    context.textAlign = 'center'
    const lowest = Math.max(...corners.map(([, y]) => y))
    const middle = corners.reduce((sum, [x]) => sum + x, 0) / 4
    context.fillText(`${length(this.box.width)} × ${length(this.box.height)}`, middle, lowest + 16)
  }

  /** By which it is sized and turned. @param {[number, number][]} corners */
  #grips(corners) {
    const { context } = this
    for (const [x, y] of corners) {
      context.fillRect(x - HANDLE / 2, y - HANDLE / 2, HANDLE, HANDLE)
      context.strokeRect(x - HANDLE / 2, y - HANDLE / 2, HANDLE, HANDLE)
    }
    const [rx, ry] = this.#ring()
    context.beginPath()
    context.arc(rx, ry, 5, 0, 2 * Math.PI)
    context.fill()
    context.stroke()
  }

  #listen() {
    const { canvas } = this
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault()
      this.zoom(Math.exp(-event.deltaY * 0.0015), [event.offsetX, event.offsetY])
    })
    canvas.addEventListener('pointerdown', (event) => this.#begin(event))
    canvas.addEventListener('pointermove', (event) => this.#go(event))
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, (event) => this.#end(/** @type {PointerEvent} */ (event)))
    canvas.addEventListener('dblclick', () => this.fit())
  }

  /** What lies under a pixel. @param {[number, number]} at */
  #under([px, py]) {
    if (this.tool) return 'tool'
    if (!this.points || this.fixed) return 'pan'
    const near = (/** @type {[number, number]} */ [x, y], /** @type {number} */ far) => Math.hypot(px - x, py - y) < far
    if (!this.holds && near(this.#ring(), 16)) return 'turn'
    if (!this.holds && this.#corners(this.box).some((corner) => near(this.toPixels(corner), 16))) return 'size'
    const [x, y] = this.toPlace([px, py])
    const [cos, sin] = [Math.cos(this.box.turn), Math.sin(this.box.turn)]
    const [dx, dy] = [x - this.box.x, y - this.box.y]
    const inside = Math.abs(dx * cos + dy * sin) <= this.box.width / 2 && Math.abs(dy * cos - dx * sin) <= this.box.height / 2
    return inside ? 'move' : 'pan'
  }

  /** @param {PointerEvent} event */
  #begin(event) {
    const at = /** @type {[number, number]} */ ([event.offsetX, event.offsetY])
    this.canvas.setPointerCapture(event.pointerId)
    this.fingers.set(event.pointerId, at)
    const kind = this.fingers.size > 1 ? 'pinch' : this.#under(at)
    this.#takeBack()
    if (kind === 'tool') this.tool?.from(this.toPlace(at))
    this.drag = { kind, from: kind === 'pinch' ? this.#pinch() : at, box: { ...this.box }, view: { ...this.view }, far: false }
  }

  /** What a drag has moved that does not end as one is put back. */
  #takeBack() {
    if (this.drag === null || !['move', 'size', 'turn'].includes(this.drag.kind)) return
    this.box = this.drag.box
    this.moved(this.box, false)
  }

  /** Ends a drag, and what a pointer shows, as if neither had begun. */
  cancel() {
    this.#takeBack()
    this.drag = null
    const { tool } = this
    this.tool = null
    tool?.cancelled()
    this.dirty = true
  }

  /** Asks a pointer to show something, or nothing any more. @param {Tool | null} tool */
  ask(tool) {
    const former = this.tool
    this.tool = null
    // one that gives way leaves nothing behind
    if (tool && former && former !== tool) former.cancelled()
    this.tool = tool
    this.canvas.dataset.under = tool ? 'tool' : 'pan'
    this.dirty = true
  }

  /** Whether the drawing lies where it was planned, and nothing else is asked for. */
  isPlanned() {
    const [{ x, y, turn, width }, was] = [this.box, this.planned]
    return Math.hypot(x - was.x, y - was.y, width - was.width) < 1e-6 && Math.abs(turn - was.turn) < 1e-6 && !document.body.classList.contains('waits')
  }

  /** Where a place is now that was planned there: it goes with the drawing while that is moved. @param {[number, number]} at @returns {[number, number]} */
  carried([x, y]) {
    const by = this.box.width / this.planned.width
    const turn = this.box.turn - this.planned.turn
    const [cos, sin] = [by * Math.cos(turn), by * Math.sin(turn)]
    const [dx, dy] = [x - this.planned.x, y - this.planned.y]
    return [this.box.x + dx * cos - dy * sin, this.box.y + dx * sin + dy * cos]
  }

  /** The fingers' middle and how far they are apart. @returns {[number, number]} */
  #pinch() {
    const [[ax, ay], [bx, by]] = [...this.fingers.values()]
    return [Math.hypot(ax - bx, ay - by), (ax + bx) / 2]
  }

  /** @param {PointerEvent} event */
  #go(event) {
    const at = /** @type {[number, number]} */ ([event.offsetX, event.offsetY])
    if (this.tool && (!this.drag || this.drag.kind === 'tool')) this.tool.to(this.toPlace(at))
    if (!this.drag) {
      this.dirty ||= this.tool !== null
      this.canvas.dataset.under = this.#under(at)
      return
    }
    this.fingers.set(event.pointerId, at)
    const { kind, from, box, view } = this.drag
    this.drag.far ||= Math.hypot(at[0] - from[0], at[1] - from[1]) > CLICK
    if (!this.drag.far && kind !== 'pinch') return
    const [dx, dy] = [(at[0] - from[0]) / this.view.scale, -(at[1] - from[1]) / this.view.scale]
    const [cx, cy] = this.toPixels([box.x, box.y])
    if (kind === 'move') this.box = { ...box, x: box.x + dx, y: box.y + dy }
    else if (kind === 'pan') {
      this.view = { ...view, x: view.x - dx, y: view.y - dy }
      this.fitted = false
    }
    else if (kind === 'pinch') this.zoom((this.#pinch()[0] / from[0]) * (view.scale / this.view.scale))
    else if (kind === 'size') {
      const by = Math.max(0.02, Math.hypot(at[0] - cx, at[1] - cy) / Math.max(8, Math.hypot(from[0] - cx, from[1] - cy)))
      this.box = { ...box, width: box.width * by, height: box.height * by }
    } else if (kind === 'turn') {
      const turned = Math.atan2(cx - at[0], cy - at[1])
      const degree = Math.PI / 180
      this.box = { ...box, turn: Math.round(turned / degree) * degree }
    }
    this.dirty = true
    if (['move', 'size', 'turn'].includes(kind)) this.moved(this.box, false)
  }

  /** @param {PointerEvent} event */
  #end(event) {
    this.fingers.delete(event.pointerId)
    if (event.type === 'pointercancel') this.#takeBack()
    const drag = event.type === 'pointercancel' ? null : this.drag
    this.drag = null
    this.dirty = true
    if (drag?.kind === 'tool') this.tool?.done(this.toPlace([event.offsetX, event.offsetY]))
    if (drag?.far && ['move', 'size', 'turn'].includes(drag.kind)) this.moved(this.box, true)
  }
}

/** @param {Box} a @param {Box} b */
function same(a, b) {
  return Math.hypot(a.x - b.x, a.y - b.y) < SPAN_M && Math.abs(a.turn - b.turn) < 1e-3 && Math.abs(a.width - b.width) < SPAN_M
}

/** Whether a picture of so many pixels a metre is too coarse or too fine for another. @param {number} of @param {number} scale */
function off(of, scale) {
  return of / scale < 0.8 || of / scale > 2.5
}
