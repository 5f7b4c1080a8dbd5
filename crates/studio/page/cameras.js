// @ts-check
/** Cameras: what one sees, live, with the pages of markers in it; printed, calibrated, and the head found; step by step. */

import * as api from './api.js'
import * as asks from './calibrations.js'
import { by, element } from './dom.js'
import { HeadCorners } from './head-corners.js'
import { fileName, tell, verdict } from './calibrated.js'
import { plain } from './words.js'

/** How long is waited after a look that failed, ms. */
const AGAIN = 3000
/** Colours of the corners of pages in an image, by their number. */
const PAGE_COLOURS = ['#ff5a4d', '#39a9ff', '#39d98a', '#ffb13d', '#d07bff', '#23d5d5']

/** @param {string} id */
const field = (id) => /** @type {HTMLInputElement} */ (by(id))
/** @param {string} id */
const shown = (id) => decodeURIComponent(id)

export class Cameras {
  /** @param {{ problem: (error: unknown) => void, place: (picture: string, calibration: string) => void, use: (flags: api.Flags) => void, changed: (all: api.Calibration[]) => void, flags: () => api.Flags, operates: boolean }} hooks */
  constructor(hooks) {
    this.hooks = hooks
    /** @type {asks.Camera[]} */
    this.all = []
    /** @type {api.Calibration[]} */
    this.known = []
    this.id = ''
    /** The one whose image is shown. */
    this.opened = ''
    this.is_shown = false
    /** Which look is the newest: others have ended. */
    this.look = 0
    /** @type {HTMLImageElement | null} */
    this.image = null
    /** @type {asks.Sight | null} */
    this.sight = null
    this.canvas = /** @type {HTMLCanvasElement} */ (by('sight'))
    this.corners = new HeadCorners({ problem: hooks.problem, made: (name) => this.#made(name), operates: hooks.operates })
    for (const id of ['hung', 'held']) by(id).addEventListener('change', () => this.#open())
    by('calibrate').addEventListener('click', () => this.#calibrate())
    by('find-head').addEventListener('click', () => this.#head())
    by('place-seen').addEventListener('click', () => hooks.place(`camera:${this.#source()}`, field('held').value))
    for (const id of ['print-paper', 'print-board']) by(id).addEventListener('change', () => this.#printed())
    new ResizeObserver(() => this.#paint()).observe(this.canvas)
    this.#printed()
  }

  /** Shows the view, with a camera or what is calibrated without one; or leaves it. @param {boolean} is @param {string} which */
  async show(is, which) {
    this.is_shown = is
    this.look++
    if (!is) return
    if (!this.hooks.operates) return void (by('camera-about').textContent = 'What cameras see is for who operates the studio: this device looks on.')
    const wanted = shown(which)
    const [all] = await Promise.all([asks.cameras(), this.#list()])
    this.all = all
    const others = element('li', {}, element('a', { href: '#cameras=corners', text: 'Head, without a camera' }))
    by('camera-list').replaceChildren(...all.map((camera) => element('li', {}, element('a', { href: `#cameras=${encodeURIComponent(camera.id)}`, text: camera.name }))), others)
    this.id = wanted === 'corners' || all.some((camera) => camera.id === wanted) ? wanted : this.id || (all.find((camera) => !camera.simulated) ?? all[0]).id
    for (const link of by('camera-list').querySelectorAll('a')) link.toggleAttribute('aria-current', link.getAttribute('href') === `#cameras=${encodeURIComponent(this.id)}`)
    const by_corners = this.id === 'corners'
    for (const id of ['seeing', 'camera-steps']) by(id).hidden = by_corners
    by('calibrated').hidden = true
    this.corners.show(by_corners)
    const camera = all.find((camera) => camera.id === this.id)
    by('camera-title').textContent = camera?.name ?? 'Head, without a camera'
    by('camera-about').textContent = by_corners ? 'Where the head stands, from the angles at which its dot is on the corners of a rectangle that was measured: a door, a board, four nails.'
      : camera?.simulated ? 'A camera, a head and a wall that are simulated: nothing is where it was said to be, as if somebody had put it up by eye. Try all of it here before a real camera.'
      : 'Leave it where it is from now on: what is found holds as long as nobody moves, zooms or focuses it.'
    const simulated = camera?.simulated ?? false
    by('hung-row').hidden = by('head-step').hidden = !simulated
    by('camera-name').setAttribute('placeholder', simulated ? 'simulated' : 'wall')
    if (!by_corners) await this.#open()
  }

  /** Reads what is calibrated. */
  async #list() {
    this.known = await api.calibrations()
    this.hooks.changed(this.known)
    const entry = (/** @type {api.Calibration} */ of) => {
      const drop = element('button', { type: 'button', class: 'away', text: '×', 'aria-label': `Delete ${of.name}` })
      drop.addEventListener('click', () => this.#drop(of))
      return element('li', { class: `known ${of.verdict ?? ''}` }, element('strong', { text: of.name }), element('small', { text: verdict(of) }), drop)
    }
    for (const kind of /** @type {const} */ (['cameras', 'heads'])) {
      const own = this.known.filter((of) => of.kind === kind)
      by(`known-${kind}`).replaceChildren(...own.map(entry))
      by(`no-${kind}`).hidden = own.length > 0
    }
    const held = /** @type {HTMLSelectElement} */ (by('held'))
    const was = held.value
    const cameras = this.known.filter((of) => of.kind === 'cameras' && !of.problem)
    held.replaceChildren(new Option('nothing', ''), ...cameras.map((of) => new Option(of.name, of.name)))
    held.value = cameras.some((of) => of.name === was) ? was : ''
    const lens = /** @type {HTMLSelectElement} */ (by('lens'))
    lens.replaceChildren(new Option('not known yet', ''), ...cameras.map((of) => new Option(of.name, of.name)))
  }

  /** @param {api.Calibration} of */
  async #drop(of) {
    try {
      const name = await asks.discardCalibration(of.kind, of.name)
      await this.#list()
      const undo = element('button', { type: 'button', class: 'plain', text: 'Undo' })
      undo.addEventListener('click', async () => {
        await api.restore(of.kind, name).catch((error) => this.hooks.problem(error))
        by('calibration-deleted').hidden = true
        await this.#list()
      })
      by('calibration-deleted').replaceChildren(`${of.name} is deleted. `, undo)
      by('calibration-deleted').hidden = false
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  /** What the camera is called, with what hangs on a simulated wall. */
  #source() {
    const hung = field('hung').value
    return this.id === 'sim' && hung ? `sim:${hung}` : this.id
  }

  /** Opens the camera that is chosen, and shows what it sees. */
  async #open() {
    const look = ++this.look
    if (this.opened !== this.#source()) {
      // what another one saw says nothing of this one
      this.sight = null
      this.image = null
      this.#paint()
      by('seen-pages').replaceChildren()
      by('seen-remarks').replaceChildren()
    }
    this.opened = this.#source()
    by('seen-words').textContent = 'Opens the camera…'
    if (this.id === 'sim' && by('hung').childElementCount === 0) {
      const pictures = (await api.pictures()).filter((picture) => picture.shows && !picture.id.endsWith('.svg'))
      by('hung').replaceChildren(new Option('nothing but the pages', ''), ...pictures.map((picture) => new Option(picture.id, picture.id)))
      field('hung').value = pictures.some((picture) => picture.id === 'house.png') ? 'house.png' : ''
    }
    let after = 0
    /** @type {number[]} when the last images came, ms */
    const times = []
    while (look === this.look && this.is_shown) {
      try {
        const sight = await asks.look(this.#source(), field('held').value, after)
        const image = new Image()
        image.src = sight.image
        await image.decode()
        if (look !== this.look) return
        after = sight.number
        times.push(performance.now())
        if (times.length > 8) times.shift()
        this.hooks.problem(null)
        this.#saw(sight, image, times)
      } catch (error) {
        if (look !== this.look) return
        by('seen-words').textContent = 'No image.'
        this.hooks.problem(error)
        after = 0
        await new Promise((done) => setTimeout(done, AGAIN))
      }
    }
  }

  /** @param {asks.Sight} sight @param {HTMLImageElement} image @param {number[]} times */
  #saw(sight, image, times) {
    this.sight = sight
    this.image = image
    this.#paint()
    const rate = times.length > 1 ? (1000 * (times.length - 1)) / (times[times.length - 1] - times[0]) : 0
    const counted = `${sight.markers.length} marker${sight.markers.length === 1 ? '' : 's'}`
    const holds = sight.calibration ? (sight.calibration.holds ? ` · the calibration holds, ${plain(sight.calibration.rms_px ?? 0, 2)} px` : ' · ⚠ the calibration does not hold') : ''
    by('seen-words').textContent = `${sight.width_px} × ${sight.height_px} px · ${counted}${holds}${rate > 0 ? ` · ${plain(rate, 1)} images a second` : ''}`
    by('seen-pages').replaceChildren(...sight.pages.map((page) => {
      const all = page.markers === page.of
      return element('li', { class: all ? 'met' : 'unmet', text: `${all ? '✓' : '◐'} page ${page.page}${page.board === 'coarse' ? ' (large)' : ''}: ${page.markers} of ${page.of}` })
    }))
    by('seen-remarks').replaceChildren(...sight.remarks.map((remark) => element('li', { text: remark })))
    by('calibrate').toggleAttribute('disabled', sight.pages.length === 0)
    if (this.id === 'sim') by('place-seen').toggleAttribute('disabled', field('hung').value === '')
  }

  /** Paints the image, and the markers that were found in it. */
  #paint() {
    const { canvas, image, sight } = this
    const width = canvas.clientWidth
    if (width === 0) return
    const ratio = devicePixelRatio
    const aspect = sight ? sight.height_px / sight.width_px : 9 / 16
    canvas.width = Math.round(width * ratio)
    canvas.height = Math.round(width * aspect * ratio)
    const context = canvas.getContext('2d')
    if (!context || !image || !sight) return
    context.drawImage(image, 0, 0, canvas.width, canvas.height)
    const scale = canvas.width / sight.width_px
    context.lineWidth = Math.max(1.5, 1.5 * ratio)
    for (const { page, corners_px } of sight.markers) {
      context.strokeStyle = PAGE_COLOURS[((page ?? 1) - 1) % PAGE_COLOURS.length]
      context.beginPath()
      for (const [x, y] of corners_px) context.lineTo(x * scale, y * scale)
      context.closePath()
      context.stroke()
    }
  }

  /** The link to the pages, as they are to be printed. */
  #printed() {
    by('print').setAttribute('href', asks.printed(field('print-paper').value, field('print-board').value))
  }

  /** Does work that takes long, once. @param {string} button @param {string} meanwhile @param {() => Promise<asks.Calibrated>} work */
  async #work(button, meanwhile, work) {
    const words = by(button).textContent
    by(button).setAttribute('disabled', '')
    by(button).textContent = meanwhile
    // the camera is the work's as long as it lasts
    this.look++
    by('seen-words').textContent = meanwhile
    try {
      const made = await work()
      this.hooks.problem(null)
      tell(by('calibrated'), made)
      await this.#list()
      // what follows is held against it
      if (made.calibration.kind === 'cameras') field('held').value = made.calibration.name
      by('calibrated').scrollIntoView({ block: 'nearest' })
    } catch (error) {
      by('calibrated').hidden = true
      this.hooks.problem(error)
    }
    by(button).textContent = words
    by(button).removeAttribute('disabled')
    if (this.is_shown) this.#open()
  }

  /** Calibrates the camera by what it sees. */
  #calibrate() {
    const flags = /** @type {api.Flags} */ ({ lens: field('lens').value, bar: field('print-bar').value.trim() })
    const name = fileName(field('camera-name').value, this.id === 'sim' ? 'simulated' : 'wall')
    return this.#work('calibrate', 'Calibrates…', () => asks.calibrate({ of: 'markers', name, camera: this.#source(), flags }))
  }

  /** Has the head draw dots, and finds it by them. */
  #head() {
    const { rig, distance } = this.hooks.flags()
    const flags = /** @type {api.Flags} */ ({ ...(rig ? { rig } : {}), ...(distance ? { distance } : {}), home: field('head-home').checked })
    const name = fileName(field('head-name').value, 'simulated')
    return this.#work('find-head', 'The head draws dots…', () => asks.calibrate({ of: 'head', name, camera: this.#source(), flags }))
  }

  /** Something was calibrated without a camera. @param {string} name */
  async #made(name) {
    await this.#list().catch((error) => this.hooks.problem(error))
    by('known-heads').querySelectorAll('strong').forEach((of) => of.textContent === name && of.scrollIntoView({ block: 'nearest' }))
  }
}
