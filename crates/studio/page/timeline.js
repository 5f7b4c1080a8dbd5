// @ts-check
/** The moment of the drawing: a slider, a button, a clock. */

import { clock } from './words.js'

export class Timeline {
  /** @param {{ range: HTMLInputElement, play: HTMLButtonElement, clock: HTMLOutputElement, rate: HTMLSelectElement }} parts @param {(row: number) => void} at */
  constructor(parts, at) {
    this.parts = parts
    this.at = at
    this.rows = 0
    this.seconds = 0
    this.playing = false
    this.row = -1
    /** The frame that is drawn next while it plays. */
    this.next = 0
    parts.range.addEventListener('input', () => {
      this.#stop()
      this.#set(Number(parts.range.value))
    })
    parts.play.addEventListener('click', () => this.toggle())
  }

  /** Takes a plan of so many rows and seconds. @param {number} rows @param {number} seconds */
  of(rows, seconds) {
    this.#stop()
    this.rows = rows
    this.seconds = seconds
    this.parts.range.max = String(Math.max(1, rows - 1))
    this.rest()
  }

  /** Shows all of it. */
  rest() {
    this.#stop()
    this.row = -1
    this.parts.range.value = '0'
    this.parts.clock.value = `0:00 / ${clock(this.seconds)}`
    this.at(-1)
  }

  /** Shows how far a job is, which may have begun anywhere. @param {number} left_s time of the plan that is left, s */
  to(left_s) {
    this.#stop()
    if (this.rows < 2 || !(this.seconds > 0)) return
    this.#set(this.rowBefore(left_s))
  }

  /** The row after which so much is left. @param {number} left_s s */
  rowBefore(left_s) {
    return Math.round(Math.min(1, Math.max(0, 1 - left_s / Math.max(this.seconds, 1e-3))) * Math.max(0, this.rows - 1))
  }

  toggle() {
    if (this.playing) this.#stop()
    else this.play(Number(this.parts.rate.value))
  }

  /** Plays on from where it is, or from the beginning. @param {number} rate */
  play(rate) {
    if (this.rows < 2) return
    this.#stop()
    this.playing = true
    this.parts.play.textContent = '❚❚'
    this.parts.play.setAttribute('aria-label', 'Pause')
    let row = this.row < 0 || this.row >= this.rows - 1 ? 0 : this.row
    const a_second = this.rows / Math.max(this.seconds, 1e-3)
    let last = performance.now()
    const frame = (/** @type {number} */ now) => {
      if (!this.playing) return
      row += ((now - last) / 1000) * rate * a_second
      last = now
      if (row >= this.rows - 1) {
        this.#set(this.rows - 1)
        this.#stop()
        return
      }
      this.#set(Math.floor(row))
      this.next = requestAnimationFrame(frame)
    }
    this.next = requestAnimationFrame(frame)
  }

  #stop() {
    cancelAnimationFrame(this.next)
    this.playing = false
    this.parts.play.textContent = '▶'
    this.parts.play.setAttribute('aria-label', 'Play')
  }

  /** @param {number} row */
  #set(row) {
    this.row = row
    this.parts.range.value = String(row)
    const seconds = (row / Math.max(1, this.rows - 1)) * this.seconds
    this.parts.clock.value = `${clock(seconds)} / ${clock(this.seconds)}`
    this.parts.range.setAttribute('aria-valuetext', `${clock(seconds)} of ${clock(this.seconds)}`)
    this.at(row)
  }
}
