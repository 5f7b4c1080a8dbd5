// @ts-check
/** The picture under its strokes: what ink they leave out is seen at a glance. */

import { pictureUrl } from './api.js'
import { Homography } from './sheet.js'

/**
 * @typedef {import('./api.js').Sheet} Sheet
 * @typedef {import('./wall.js').Wall} Wall
 */

/** Largest picture that is shown, pixels either way. */
const MOST_PIXELS = 1600
/** Parts either way of a picture that is not shown straight: each is nearly so. */
const PARTS = 12
/** By so many levels a ground differs from itself. */
const GROUND = 16

export class Beneath {
  /** @param {HTMLInputElement} range how much of it is seen, in percent @param {Wall} wall */
  constructor(range, wall) {
    this.range = range
    this.wall = wall
    this.of = ''
    /** @type {HTMLImageElement | null} */
    this.image = null
    /** Its ink alone, in the colour of a ground. @type {{ ink: HTMLCanvasElement, colour: string } | null} */
    this.inked = null
    /** @type {Sheet | null} */
    this.sheet = null
    wall.beneath.push(this)
    range.addEventListener('input', () => (wall.dirty = true))
  }

  /** Takes a picture as it was planned, or none. @param {string} picture @param {Sheet | null} sheet */
  show(picture, sheet) {
    this.sheet = sheet?.picture_px ? sheet : null
    this.range.parentElement?.toggleAttribute('hidden', this.sheet === null)
    if (this.sheet === null || picture === this.of) return
    this.of = picture
    this.image = null
    this.inked = null
    const image = new Image()
    image.addEventListener('load', () => {
      if (picture !== this.of || image.naturalWidth === 0) return
      this.image = image
      this.wall.dirty = true
    })
    image.src = pictureUrl(picture)
  }

  /** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {import('./paint.js').Colours} colours */
  draw(context, wall, colours) {
    const share = Number(this.range.value) / 100
    if (!this.image || !this.sheet?.picture_px || share === 0) return
    const { ink } = this.#ink(this.image, colours.soft)
    const [wide, high] = this.sheet.picture_px
    const lies = new Homography(this.sheet.corners, this.sheet.target_m)
    const parts = lies.isAffine(Math.max(wide, high)) ? 1 : PARTS
    const to = (/** @type {number} */ x, /** @type {number} */ y) => wall.toPixels(wall.carried(lies.apply([(x * wide) / parts, (y * high) / parts])))
    context.save()
    context.globalAlpha = share
    for (let y = 0; y < parts; y++) {
      for (let x = 0; x < parts; x++) {
        const corners = /** @type {[number, number][]} */ ([[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]])
        // what is beyond the horizon is on no wall
        if (corners.every(([u, v]) => lies.isInFront([(u * wide) / parts, (v * high) / parts]))) part(context, ink, [x, y], parts, corners.map(([u, v]) => to(u, v)))
      }
    }
    context.restore()
  }

  /** What differs from the picture's ground, in a colour, as opaque as it differs. @param {HTMLImageElement} image @param {string} colour */
  #ink(image, colour) {
    if (this.inked?.colour === colour) return this.inked
    const by = Math.min(1, MOST_PIXELS / Math.max(image.naturalWidth, image.naturalHeight))
    const ink = document.createElement('canvas')
    ink.width = Math.max(1, Math.round(image.naturalWidth * by))
    ink.height = Math.max(1, Math.round(image.naturalHeight * by))
    const context = /** @type {CanvasRenderingContext2D} */ (ink.getContext('2d', { willReadFrequently: true }))
    // where a picture is transparent there is paper
    context.fillStyle = '#ffffff'
    context.fillRect(0, 0, ink.width, ink.height)
    context.drawImage(image, 0, 0, ink.width, ink.height)
    const pixels = context.getImageData(0, 0, ink.width, ink.height)
    const grey = (/** @type {number} */ n) => 0.3 * pixels.data[n] + 0.59 * pixels.data[n + 1] + 0.11 * pixels.data[n + 2]
    // what most of it is like is its ground: paper, or a board on which chalk is the ink
    const counts = new Uint32Array(256)
    for (let n = 0; n < pixels.data.length; n += 4) counts[Math.round(grey(n))]++
    const ground = counts.reduce((most, count, level) => (count > counts[most] ? level : most), 0)
    const span = Math.max(ground, 255 - ground) - GROUND
    for (let n = 0; n < pixels.data.length; n += 4) pixels.data[n + 3] = (255 * Math.max(0, Math.abs(grey(n) - ground) - GROUND)) / span
    context.putImageData(pixels, 0, 0)
    context.globalCompositeOperation = 'source-in'
    context.fillStyle = colour
    context.fillRect(0, 0, ink.width, ink.height)
    this.inked = { ink, colour }
    return this.inked
  }
}

/** A part of a picture where its corners go: left top, right top, left low, right low; by two triangles where it is not alone. @param {CanvasRenderingContext2D} context @param {HTMLCanvasElement} image @param {[number, number]} which @param {number} parts @param {[number, number][]} to */
function part(context, image, [x, y], parts, [a, b, c, d]) {
  const [wide, high] = [image.width / parts, image.height / parts]
  const [left, top] = [x * wide, y * high]
  const half = (/** @type {[number, number]} */ corner, /** @type {[number, number]} */ across, /** @type {[number, number]} */ down, /** @type {number} */ from_x, /** @type {number} */ from_y, /** @type {number} */ way) => {
    context.save()
    if (parts > 1) {
      context.beginPath()
      for (const at of [corner, across, down]) context.lineTo(...at)
      context.clip()
    }
    const [ux, uy] = [(way * (across[0] - corner[0])) / wide, (way * (across[1] - corner[1])) / wide]
    const [vx, vy] = [(way * (down[0] - corner[0])) / high, (way * (down[1] - corner[1])) / high]
    context.transform(ux, uy, vx, vy, corner[0] - ux * from_x - vx * from_y, corner[1] - uy * from_x - vy * from_y)
    context.drawImage(image, left, top, wide, high, left, top, wide, high)
    context.restore()
  }
  half(a, b, c, left, top, 1)
  if (parts > 1) half(d, c, b, left + wide, top + high, -1)
}
