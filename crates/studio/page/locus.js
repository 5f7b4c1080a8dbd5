// @ts-check
/** A root locus whose closed poles are dragged along their branches: gain, damping and the step of the closed loop follow. */

import * as api from './api.js'
import { element } from './dom.js'
import { plain } from './words.js'

/** How near to a pole a pointer takes it, pixels. */
const NEAR = 28
/** How long a gain rests before its step is asked for, ms. */
const REST = 120
/** Damping ratios whose lines are drawn. */
const RATIOS = [0.2, 0.4, 0.6, 0.8]

/**
 * @typedef {[number, number]} Pole real and imaginary part, rad/s
 * @typedef {{ name: string, branches: Pole[][], gains: number[], poles: Pole[], zeros: Pole[], period_s: number | null }} Found
 */

export class Locus {
  /** @param {HTMLElement} place @param {(error: unknown) => void} problem */
  constructor(place, problem) {
    this.problem = problem
    /** @type {Found | null} */
    this.found = null
    this.formula = ''
    /** Which gain. */
    this.at = 0
    this.timer = 0
    this.number = 0
    this.address = ''
    this.dragged = false
    /** Middle of what is shown, rad/s, and pixels a rad/s. */
    this.view = { x: 0, y: 0, scale: 1 }
    this.canvas = /** @type {HTMLCanvasElement} */ (element('canvas', { class: 'locus', role: 'img', 'aria-label': 'The root locus. Drag a closed pole, or move the slider below.' }))
    this.range = /** @type {HTMLInputElement} */ (element('input', { type: 'range', min: '0', step: '1', 'aria-label': 'Gain k' }))
    this.words = element('p', { role: 'status' })
    this.step = element('div', { class: 'plot' })
    this.told = element('pre', { tabindex: '0', role: 'region', 'aria-label': 'The step of the closed loop' })
    const fit = element('button', { type: 'button', class: 'plain', text: 'Show all' })
    fit.addEventListener('click', () => this.#fit())
    place.replaceChildren(this.canvas, element('div', { class: 'gain' }, this.range, fit), this.words, this.step, this.told)
    this.range.addEventListener('input', () => this.#to(Number(this.range.value)))
    this.canvas.addEventListener('pointerdown', (event) => this.#down(event))
    this.canvas.addEventListener('pointermove', (event) => this.#move(event))
    for (const name of ['pointerup', 'pointercancel']) this.canvas.addEventListener(name, () => (this.dragged = false))
    this.canvas.addEventListener('wheel', (event) => this.#zoom(event), { passive: false })
    new ResizeObserver(() => this.#fit()).observe(this.canvas)
  }

  /** Shows where the poles of a loop go; at its own gain first. @param {Found} found @param {string} formula */
  show(found, formula) {
    this.found = found
    this.formula = formula
    this.range.max = String(found.gains.length - 1)
    this.#fit()
    this.#to(nearest(found.gains, 1))
  }

  /** Asks for nothing any more. */
  leave() {
    clearTimeout(this.timer)
    this.number++
  }

  /** Shows all open poles and zeros, and where the closed ones are at gains that anybody uses. */
  #fit() {
    const { found } = this
    if (!found) return
    const width = this.canvas.clientWidth
    if (width === 0) return
    const height = Math.round(Math.min(460, 0.62 * width))
    this.canvas.style.height = `${height}px`
    this.canvas.width = Math.round(width * devicePixelRatio)
    this.canvas.height = Math.round(height * devicePixelRatio)
    const one = nearest(found.gains, 4)
    const all = [...found.poles, ...found.zeros, ...found.branches.slice(0, one + 1).flat()].filter(([x, y]) => Number.isFinite(x + y))
    const [left, right] = [Math.min(...all.map(([x]) => x), 0), Math.max(...all.map(([x]) => x), 0)]
    const high = Math.max(...all.map(([, y]) => Math.abs(y)), 0.25 * (right - left), 1e-9)
    const wide = Math.max(right - left, 1e-9)
    this.view = { x: (left + right) / 2, y: 0, scale: Math.min(width / (1.2 * wide), height / (2.4 * high)) }
    this.#paint()
  }

  /** @param {Pole} pole @returns {[number, number]} pixels of the page */
  #toPixels([x, y]) {
    const { view, canvas } = this
    return [canvas.clientWidth / 2 + (x - view.x) * view.scale, canvas.clientHeight / 2 - (y - view.y) * view.scale]
  }

  /** @param {MouseEvent} event @returns {Pole} */
  #place(event) {
    const { view, canvas } = this
    const box = canvas.getBoundingClientRect()
    return [view.x + (event.clientX - box.left - canvas.clientWidth / 2) / view.scale, view.y - (event.clientY - box.top - canvas.clientHeight / 2) / view.scale]
  }

  /** @param {PointerEvent} event */
  #down(event) {
    const { found } = this
    if (!found) return
    const [x, y] = this.#place(event)
    const near = found.branches[this.at].some(([u, v]) => Math.hypot(u - x, v - y) * this.view.scale < NEAR)
    if (!near) return
    this.dragged = true
    this.canvas.setPointerCapture(event.pointerId)
    event.preventDefault()
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const { found } = this
    if (!this.dragged || !found) return
    const [x, y] = this.#place(event)
    // the gain at which any pole is nearest to where it is dragged
    let [best, at] = [Infinity, this.at]
    found.branches.forEach((poles, n) => {
      for (const [u, v] of poles) {
        const far = Math.hypot(u - x, v - y)
        if (far < best) [best, at] = [far, n]
      }
    })
    this.#to(at)
  }

  /** @param {WheelEvent} event */
  #zoom(event) {
    event.preventDefault()
    const [x, y] = this.#place(event)
    const by = event.deltaY < 0 ? 1.25 : 0.8
    const { view } = this
    this.view = { x: x + (view.x - x) / by, y: y + (view.y - y) / by, scale: view.scale * by }
    this.#paint()
  }

  /** Takes a gain, and asks for the step that it makes. @param {number} at */
  #to(at) {
    const { found } = this
    if (!found) return
    this.at = at
    this.range.value = String(at)
    const gain = found.gains[at]
    const slowest = leastDamped(found.branches[at], found.period_s)
    this.words.replaceChildren(element('strong', { text: `k = ${shown(gain)}` }), ` · ${slowest}`)
    this.range.setAttribute('aria-valuetext', `k = ${shown(gain)}, ${slowest}`)
    this.#paint()
    clearTimeout(this.timer)
    this.timer = window.setTimeout(() => this.#ask(gain), REST)
  }

  /** @param {number} gain */
  async #ask(gain) {
    const number = ++this.number
    if (!(gain > 0)) return
    try {
      const told = await api.experiment({ command: 'response', of: [`${Number(gain.toPrecision(6))}*(${this.formula})`], flags: { closed: true } })
      if (number !== this.number) return
      URL.revokeObjectURL(this.address)
      this.address = URL.createObjectURL(new Blob([told.svg], { type: 'image/svg+xml' }))
      this.step.replaceChildren(element('img', { src: this.address, alt: `Step of the closed loop at k = ${shown(gain)}` }))
      this.told.textContent = told.words
      this.problem(null)
    } catch (error) {
      if (number !== this.number) return
      this.step.replaceChildren()
      this.told.textContent = ''
      this.problem(error)
    }
  }

  #paint() {
    const { canvas, found, view } = this
    const context = canvas.getContext('2d')
    if (!context || !found) return
    const style = getComputedStyle(document.documentElement)
    const colour = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`)
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0)
    context.fillStyle = colour('wall')
    context.fillRect(0, 0, canvas.clientWidth, canvas.clientHeight)
    axes(context, canvas, view, colour, found.period_s === null)
    context.strokeStyle = colour('accent')
    context.lineWidth = 2
    // branches are told gain by gain: each pole's way is a line
    for (let branch = 0; branch < (found.branches[0]?.length ?? 0); branch++) {
      context.beginPath()
      found.branches.forEach((poles, n) => {
        const [x, y] = this.#toPixels(poles[branch] ?? [NaN, NaN])
        const before = n > 0 ? this.#toPixels(found.branches[n - 1][branch] ?? [NaN, NaN]) : [x, y]
        // where branches meet, they may change places in the list
        const far = Math.hypot(x - before[0], y - before[1]) > 60
        if (n === 0 || far) context.moveTo(x, y)
        else context.lineTo(x, y)
      })
      context.stroke()
    }
    context.strokeStyle = colour('ink')
    context.lineWidth = 2
    for (const pole of found.poles) cross(context, this.#toPixels(pole))
    for (const zero of found.zeros) ring(context, this.#toPixels(zero), 6)
    context.fillStyle = colour('light')
    for (const pole of found.branches[this.at] ?? []) {
      context.beginPath()
      context.arc(...this.#toPixels(pole), 7, 0, 2 * Math.PI)
      context.fill()
    }
  }
}

/** Which of numbers that rise is nearest to one. @param {number[]} numbers @param {number} one */
function nearest(numbers, one) {
  return numbers.reduce((best, number, n) => (Math.abs(number - one) < Math.abs(numbers[best] - one) ? n : best), 0)
}

/** @param {number} gain */
const shown = (gain) => String(Number(gain.toPrecision(4)))

/** What the least damped of poles is like. @param {Pole[]} poles @param {number | null} period_s of a loop in discrete time */
function leastDamped(poles, period_s) {
  const continuous = poles.map(([x, y]) => (period_s === null ? [x, y] : [Math.log(Math.hypot(x, y)) / period_s, Math.atan2(y, x) / period_s]))
  if (continuous.some(([x]) => x > 1e-9)) return 'not stable'
  const ratios = continuous.filter(([x, y]) => Math.hypot(x, y) > 1e-9).map(([x, y]) => [-x / Math.hypot(x, y), Math.hypot(x, y)])
  if (ratios.length === 0) return ''
  const [ratio, natural] = ratios.reduce((least, of) => (of[0] < least[0] ? of : least))
  return ratio > 0.9999 ? 'no pole oscillates' : `the least damped pair: damping ${plain(ratio, 3)}, natural frequency ${shown(natural)} rad/s`
}

/** @param {CanvasRenderingContext2D} context @param {[number, number]} at */
function cross(context, [x, y]) {
  context.beginPath()
  context.moveTo(x - 6, y - 6)
  context.lineTo(x + 6, y + 6)
  context.moveTo(x - 6, y + 6)
  context.lineTo(x + 6, y - 6)
  context.stroke()
}

/** @param {CanvasRenderingContext2D} context @param {[number, number]} at @param {number} radius */
function ring(context, [x, y], radius) {
  context.beginPath()
  context.arc(x, y, radius, 0, 2 * Math.PI)
  context.stroke()
}

/** Axes with their figures; of continuous time the lines of equal damping, of discrete time the unit circle. @param {CanvasRenderingContext2D} context @param {HTMLCanvasElement} canvas @param {{ x: number, y: number, scale: number }} view @param {(name: string) => string} colour @param {boolean} continuous */
function axes(context, { clientWidth: width, clientHeight: height }, view, colour, continuous) {
  const [zero_x, zero_y] = [width / 2 - view.x * view.scale, height / 2 + view.y * view.scale]
  const step = nice(90 / view.scale)
  context.font = '12px system-ui, sans-serif'
  context.lineWidth = 1
  context.strokeStyle = colour('grid')
  context.fillStyle = colour('soft')
  context.beginPath()
  for (let n = Math.ceil((view.x - width / 2 / view.scale) / step); n * step < view.x + width / 2 / view.scale; n++) {
    const x = zero_x + n * step * view.scale
    context.moveTo(x, 0)
    context.lineTo(x, height)
    context.fillText(shown(n * step), x + 3, height - 5)
  }
  for (let n = Math.ceil((view.y - height / 2 / view.scale) / step); n * step < view.y + height / 2 / view.scale; n++) {
    const y = zero_y - n * step * view.scale
    context.moveTo(0, y)
    context.lineTo(width, y)
    if (n !== 0) context.fillText(`${shown(n * step)} j`, 4, y - 3)
  }
  context.stroke()
  context.strokeStyle = colour('rule')
  context.setLineDash([4, 4])
  context.beginPath()
  const far = 2 * (width + height)
  for (const ratio of continuous ? RATIOS : []) {
    for (const up of [-1, 1]) {
      context.moveTo(zero_x, zero_y)
      context.lineTo(zero_x - far * ratio, zero_y + up * far * Math.sqrt(1 - ratio * ratio))
    }
  }
  if (!continuous) context.arc(zero_x, zero_y, view.scale, 0, 2 * Math.PI)
  context.stroke()
  context.setLineDash([])
  context.strokeStyle = colour('soft')
  context.beginPath()
  context.moveTo(zero_x, 0)
  context.lineTo(zero_x, height)
  context.moveTo(0, zero_y)
  context.lineTo(width, zero_y)
  context.stroke()
  context.fillText('rad/s', width - 38, zero_y - 5)
}

/** A step of 1, 2 or 5 times a power of ten, at least that. @param {number} least */
function nice(least) {
  const power = 10 ** Math.floor(Math.log10(least))
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= least) ?? 10 * power
}
