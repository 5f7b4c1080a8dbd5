// @ts-check
/** Two runs side by side: their walls under one cursor, their figures, what was asked of only one. */

import * as api from './api.js'
import { by, element } from './dom.js'
import { named } from './words.js'

const MOST = 40

/** Walls that move and zoom together. */
class Pair {
  constructor() {
    /** @type {{ pane: HTMLElement, image: HTMLElement, cross: HTMLElement }[]} */
    this.panes = []
    this.scale = 1
    this.x = 0
    this.y = 0
    by('pair-in').addEventListener('click', () => this.#zoom(1.5, 0.5, 0.5))
    by('pair-out').addEventListener('click', () => this.#zoom(1 / 1.5, 0.5, 0.5))
    by('pair-fit').addEventListener('click', () => this.#fit())
  }

  /** @param {api.RunTold[]} runs */
  show(runs) {
    this.panes = runs.map((run) => {
      const image = element('img', { src: api.runFile(run.id, 'trace.png'), alt: `What a camera with an open shutter would have seen of ${run.id}`, draggable: 'false' })
      const cross = element('span', { class: 'cross', 'aria-hidden': 'true' })
      const pane = element('div', { class: 'pane' }, image, cross)
      this.#listen(pane)
      return { pane, image, cross }
    })
    by('pair').replaceChildren(...this.panes.map(({ pane }, n) => element('figure', {}, element('figcaption', { text: runs[n].id }), pane)))
    this.#fit()
  }

  #fit() {
    this.scale = 1
    this.x = this.y = 0
    this.#draw()
  }

  /** @param {HTMLElement} pane */
  #listen(pane) {
    /** @type {[number, number] | null} */
    let from = null
    const share = (/** @type {PointerEvent | WheelEvent} */ event) => {
      const box = pane.getBoundingClientRect()
      return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height]
    }
    pane.addEventListener('pointerdown', (event) => {
      pane.setPointerCapture(event.pointerId)
      from = [event.clientX, event.clientY]
    })
    pane.addEventListener('pointermove', (event) => {
      const [x, y] = share(event)
      for (const { cross } of this.panes) {
        cross.style.left = `${100 * x}%`
        cross.style.top = `${100 * y}%`
      }
      if (!from) return
      this.x += (event.clientX - from[0]) / pane.clientWidth
      this.y += (event.clientY - from[1]) / pane.clientHeight
      from = [event.clientX, event.clientY]
      this.#draw()
    })
    for (const over of ['pointerup', 'pointercancel']) pane.addEventListener(over, () => (from = null))
    pane.addEventListener('wheel', (event) => {
      event.preventDefault()
      const [x, y] = share(event)
      this.#zoom(Math.exp(-event.deltaY / 400), x, y)
    }, { passive: false })
  }

  /** About a place, shares of a pane. @param {number} factor @param {number} x @param {number} y */
  #zoom(factor, x, y) {
    const scale = Math.min(MOST, Math.max(1, this.scale * factor))
    const by_how = scale / this.scale
    this.x = x - (x - this.x) * by_how
    this.y = y - (y - this.y) * by_how
    this.scale = scale
    this.#draw()
  }

  #draw() {
    // no wall leaves its pane
    const least = 1 - this.scale
    this.x = Math.min(0, Math.max(least, this.x))
    this.y = Math.min(0, Math.max(least, this.y))
    for (const { image } of this.panes) image.style.transform = `translate(${100 * this.x}%, ${100 * this.y}%) scale(${this.scale})`
  }
}

const pair = new Pair()

/** Shows two runs. @param {string} first @param {string} second */
export async function showCompared(first, second) {
  const told = await api.compare(first, second)
  by('compare-title').textContent = `${first} and ${second}`
  pair.show([told.first, told.second])
  const value = (/** @type {number | null} */ of, /** @type {api.Compared['figures'][0]} */ figure) => (of === null ? '–' : `${of.toFixed(figure.digits)} ${figure.unit}`)
  const difference = (/** @type {api.Compared['figures'][0]} */ figure) => {
    if (figure.difference === null) return '–'
    const text = figure.difference.toFixed(figure.digits)
    return Number(text) === 0 ? 'same' : `${figure.difference > 0 ? '+' : '−'}${text.replace('-', '')} ${figure.unit}`
  }
  const head = element('tr', {}, ...['', first, second, 'Second less first'].map((text) => (text ? element('th', { scope: 'col', text }) : element('td'))))
  const rows = told.figures.map((figure) =>
    element('tr', {}, element('th', { scope: 'row', text: figure.name }), ...[value(figure.first, figure), value(figure.second, figure), difference(figure)].map((text) => element('td', { text }))),
  )
  by('compare-figures').replaceChildren(element('thead', {}, head), element('tbody', {}, ...rows))
  const asked = [[first, told.only_first_asked], [second, told.only_second_asked]]
  const lines = asked.filter(([, words]) => words.length > 0).map(([id, words]) => element('p', {}, `Only ${id} was asked: `, element('code', { text: /** @type {string[]} */ (words).map((word) => (word.startsWith('--') ? word : named(word))).join(' ') })))
  if (lines.length === 0) lines.push(element('p', { text: 'Both were asked the same.' }))
  for (const run of [told.first, told.second]) if (!run.finished) lines.push(element('p', { class: 'said', text: `${run.id} did not finish: its figures are of the part that was drawn.` }))
  if (!told.same_drawing) lines.push(element('p', { class: 'said', text: 'They have other strokes: the figures are of two drawings.' }))
  by('compare-asked').replaceChildren(...lines)
}
