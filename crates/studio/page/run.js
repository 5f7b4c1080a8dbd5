// @ts-check
/** Somebody attends a job: before light, arming, and what may be asked while it is drawn. */

import * as api from './api.js'
import { by, element } from './dom.js'
import { asLabelled } from './fields.js'
import { Hold } from './hold.js'
import { Live } from './live.js'
import { follow } from './jobs.js'
import { isCamera, isRoom, plain, time } from './words.js'

/** What was told longer ago is not known any more, ms. */
const STALE = 400
/** How long it is known why a job stops, ms. */
const KNOWN = 2000
/** States in which the job is on. */
const ON = ['tracing', 'stepping', 'pointing', 'framing', 'returning', 'pausing']
/** What states are called. @type {Record<string, string>} */
const STATES = {
  unhomed: 'It does not know where it points', ready: 'Ready, dark', parking: 'Goes to zero, dark', armed: 'Armed', framing: 'Shows the frame', tracing: 'Traces', stepping: 'Draws it again and again',
  pointing: 'Marks a point', returning: 'Dark, on its way back to the stroke', pausing: 'Pauses after this stroke', homing: 'Finds out where it points, by dots', jogging: 'Moves, dark', marking: 'Shows a dot', paused: 'Paused, dark', stopped: 'Stopped, dark', done: 'Done, dark', fault: 'A fault: dark', lost: 'The head is gone',
}

/**
 * @typedef {{ asked: () => { picture: string, flags: api.Flags }, at: (left_s: number, lit: boolean, of_s: number) => void, stroke: (number: number, share: number, lit: boolean) => void, mark: (at: [number, number] | null) => void, ended: (job: api.Job) => void, problem: (error: unknown) => void, lamp: (text: string, lit: boolean) => void, heads: () => void }} Hooks
 *   what is shown; how long of the plan is left, s, −1 for nowhere, whether there is light, and how long all of the job's plan is; the stroke that is drawn again and again; the place that is marked; how it ended
 */

/** What is typed or chosen in a field. @param {string} id */
const field = (id) => /** @type {HTMLInputElement} */ (by(id))

export class Run {
  /** @param {string} page @param {Hooks} hooks */
  constructor(page, hooks) {
    this.page = page
    this.hooks = hooks
    this.on = false
    this.mine = false
    this.mode = 'trace'
    this.framing = false
    /** @type {api.RunTold | null} the run whose rest is to be drawn */
    this.rest = null
    /** Until when it is known why it stops, ms. */
    this.knows = 0
    /** A job is followed to its end. */
    this.follows = false
    /** The job has told how far it is. */
    this.began = false
    /** @type {{ real: boolean } | null} the board at a port that draws the job, if one does */
    this.head = null
    /** Whether a board at a port draws. */
    this.at_port = false
    /** Whether this device may operate anything. */
    this.operates = true
    /** @type {WakeLockSentinel | null} keeps a phone's screen on: one that sleeps stops the job */
    this.awake = null
    /** A job was asked for, and has not begun. */
    this.begins = false
    this.state = ''
    /** @type {import('./live.js').Told | null} the point that is marked */
    this.point = null
    /** @type {import('./live.js').Told | null} what the camera has seen of the light */
    this.seen = null
    /** How a camera looks into what is off. */
    this.looks = 'over'
    /** When it was last told how far it is, ms. */
    this.heard = 0
    /** @type {import('./live.js').Told} */
    this.now = { event: 'progress' }
    this.live = new Live(page, (told) => this.#hear(told), (open) => this.#opened(open))
    this.arm = new Hold(by('arm'), () => this.#ask('arm'))
    by('begin').addEventListener('click', () => this.begin())
    by('go').addEventListener('click', () => this.#ask(this.framing && this.state !== 'armed' ? 'next' : 'go-on'))
    by('pause').addEventListener('click', () => this.#ask('pause'))
    by('pause-now').addEventListener('click', () => this.#ask('pause-now'))
    by('next').addEventListener('click', () => this.#ask('next'))
    by('previous').addEventListener('click', () => this.#ask('previous'))
    by('skip').addEventListener('click', () => this.#ask('skip'))
    by('clear').addEventListener('click', () => this.#ask('clear'))
    by('end').addEventListener('click', () => this.#ask('end'))
    by('take').addEventListener('click', () => this.#ask('take'))
    by('whole').addEventListener('click', () => this.goOnWith(null))
    by('refuse').addEventListener('click', () => this.#refuse())
    by('faster').addEventListener('change', () => this.#ask(`speed=${Number(field('faster').value) / 100}`))
    by('faster').addEventListener('input', () => (by('percent').textContent = `${field('faster').value} %`))
    for (const radio of document.querySelectorAll('input[name=mode]')) radio.addEventListener('change', () => this.modes())
    setInterval(() => this.#stale(), 100)
    document.addEventListener('visibilitychange', () => this.#wake())
    this.modes()
  }

  /** Takes the rest of a run as what is to be drawn, or again the drawing as it is placed. @param {api.RunTold | null} run */
  goOnWith(run) {
    this.rest = run
    this.modes()
    this.hooks.heads()
  }

  /** Another drawing is on the wall: how the one before was to be drawn is not how this one is. */
  anew() {
    field('from-stroke').value = ''
    by('attended').hidden = true
    this.goOnWith(null)
  }

  /** Whether a job is on, or about to be. */
  busy() {
    return this.on || this.begins || this.follows
  }

  /** Says what draws: a head at a port keeps time by itself, and a real one is nobody's to hurry. @param {boolean} at_port @param {boolean} is_real */
  atPort(at_port, is_real) {
    this.at_port = at_port
    by('times-row').hidden = at_port
    by('by-what').textContent = is_real ? 'With the real head, whose light is real: see that nobody stands in it' : at_port ? 'With the board at the port' : 'By the clock, as at a real head'
  }

  /** Begins at a stroke. @param {number} number */
  from(number) {
    this.goOnWith(null)
    field('from-stroke').value = String(number)
  }

  /** The job to begin: its picture or run, and flags. */
  #flags() {
    const { picture, flags } = this.hooks.asked()
    /** @type {api.Flags} */
    const how = {}
    const times = field('times').value
    if (times !== '1' && !this.at_port) how.real_time = times
    if (field('frame').value !== '' && !isCamera(picture)) how.frame = field('frame').value
    if (this.rest) return { rest_of: this.rest.id, flags: how }
    const asked = { ...flags, ...how }
    const mode = isCamera(picture) ? 'trace' : this.#mode()
    if (isRoom(picture) && field('trouble').value !== '') asked.sim_trouble = field('trouble').value
    if (field('dry').checked) asked.dry_run = true
    const from = field('from-stroke').value.trim()
    if (from !== '' && from !== '1' && !isCamera(picture)) asked.from_stroke = from
    if (mode === 'step') asked.step = true
    if (mode === 'points') asked.points = 'all'
    if (mode !== 'trace' && field('pace').value.trim() !== '') asked.pace = field('pace').value.trim()
    return { picture, flags: asked }
  }

  #mode() {
    return /** @type {HTMLInputElement | null} */ (document.querySelector('input[name=mode]:checked'))?.value ?? 'trace'
  }

  /** Shows what may be asked of what is to be drawn. */
  modes() {
    const { rest } = this
    by('trouble-row').hidden = rest !== null || !isRoom(this.hooks.asked().picture)
    by('pace-row').hidden = this.#mode() === 'trace' || rest !== null
    by('rest').hidden = rest === null
    by('rest-words').textContent = rest ? `The rest of ${rest.id}${rest.progress ? `, from stroke ${rest.progress.stroke} of ${rest.progress.strokes}` : ''}, as it was asked then.` : ''
    for (const id of ['modes', 'from-row', 'dry-row']) by(id).hidden = rest !== null
  }

  /** Begins a job, dark: it waits until somebody arms it. */
  async begin() {
    if (this.on || this.begins) return
    this.hooks.problem(null)
    by('attended').hidden = true
    this.begins = true
    enable('begin', false)
    try {
      this.mode = this.rest || isCamera(this.hooks.asked().picture) ? 'trace' : this.#mode()
      this.#say('')
      by('checks').replaceChildren()
      this.live.open()
      await api.attend({ page: this.page, ...this.#flags() })
      this.#show()
      await this.followed()
    } catch (error) {
      this.hooks.problem(error)
    } finally {
      this.begins = false
      enable('begin', true)
      this.#show()
    }
  }

  /** Follows the job that is on to its end; one that another page began too. */
  async followed() {
    if (this.follows) return
    this.follows = true
    // until the job's line tells
    this.hooks.lamp('? Unknown', false)
    this.live.open()
    const ended = await follow(() => {}, true).catch((error) => (this.hooks.problem(error), null))
    this.follows = this.began = false
    this.head = null
    this.on = this.mine = this.live.operates = this.framing = false
    this.state = ''
    this.live.close()
    this.#show()
    this.hooks.lamp(ended ? '● Dark' : '? Unknown', false)
    this.hooks.at(-1, false, 0)
    this.hooks.mark(null)
    this.point = null
    this.#wake()
    // what was left is drawn, or another run has its rest; what never began is still to be drawn
    if (ended?.answer) this.goOnWith(null)
    if (ended?.answer) field('from-stroke').value = ''
    field('trouble').value = ''
    if (ended) this.hooks.ended(ended)
    this.hooks.heads()
  }

  /** Stops it: anybody may. */
  stop() {
    this.#know()
    this.arm.cancel()
    this.live.wish('stop')
  }

  /** What a key asks for while a job is on. @param {KeyboardEvent} event @returns {boolean} whether it asked for something */
  key(event) {
    if (event.key.toLowerCase() === 'a' && !event.repeat && this.on) {
      this.arm.begin()
      return true
    }
    if (!this.on || !this.mine) return false
    const steps = this.state === 'stepping' || this.state === 'pointing'
    if (event.key === ' ') {
      if (steps) this.#ask('next')
      else if (ON.includes(this.state)) this.#ask('pause')
      else if (this.state === 'paused') this.#ask('go-on')
      return true
    }
    const wish = { '.': 'next', PageDown: 'next', ',': 'previous', PageUp: 'previous' }[event.key]
    if (wish && this.mode !== 'trace') this.#ask(wish)
    return wish !== undefined
  }

  /** A key that was held is let go. */
  released() {
    this.arm.cancel()
  }

  /** Keeps the screen on as long as this page operates a job, where the browser can. */
  async #wake() {
    const wanted = this.on && this.mine && document.visibilityState === 'visible'
    try {
      if (!wanted) {
        await this.awake?.release()
        this.awake = null
      } else if (!this.awake || this.awake.released) this.awake = (await navigator.wakeLock?.request('screen')) ?? null
    } catch {
      // one that sleeps is missed, and dark
    }
  }

  /** For a moment it is known why it stops. */
  #know() {
    this.knows = performance.now() + KNOWN
  }

  /** @param {string} wish */
  #ask(wish) {
    navigator.vibrate?.(30)
    if (!this.live.wish(wish)) this.hooks.problem(new api.Refusal({ code: 'gone', message: 'There is no line to the job: it is dark by itself within two seconds.' }, 0))
  }

  #refuse() {
    by('asks').hidden = true
    this.#ask('refuse')
  }

  /** @param {boolean} open */
  #opened(open) {
    if (!open) this.heard = 0
  }

  /** @param {import('./live.js').Told} told */
  #hear(told) {
    if (told.event === 'live' || told.event === 'begun' || told.event === 'operator') {
      const operator = told.operator ?? told.page
      this.on = told.event !== 'live' || told.on
      this.mine = this.live.operates = this.on && this.operates && operator === this.page
      this.#wake()
      by('asks').hidden = true
      if (told.event === 'operator') this.#know()
      if (told.mode) this.mode = told.mode
      if (told.event === 'begun') {
        // nothing of the one before holds
        this.began = false
        this.head = null
        this.now = { event: 'progress' }
        this.state = ''
        this.point = null
        this.seen = null
        this.looks = 'over'
        this.framing = false
        this.heard = performance.now()
        // on a phone what comes next is in view, before anybody can hold a button there
        if (this.mine) scrollTo({ top: 0 })
      }
    } else if (told.event === 'progress') {
      this.now = told
      this.heard = performance.now()
      this.state = told.state
      if (!this.began) {
        this.began = true
        this.hooks.heads()
      }
      this.#place()
    } else if (told.event === 'head') {
      this.head = { real: told.real }
      this.hooks.heads()
    } else if (told.event === 'over') {
      this.on = this.mine = this.live.operates = false
    } else if (told.event === 'preflight') {
      by('checks').replaceChildren(...told.checks.map(check))
    } else if (told.event === 'frame') {
      this.framing = told.on
    } else if (told.event === 'asks') {
      by('asks').hidden = !this.mine
    } else if (told.event === 'refuses' && told.page === this.page) {
      this.#say('The page that operates it keeps it.')
    } else if (told.event === 'refused') {
      this.#say(told.message)
      // what was refused is not so
      const percent = Math.round(100 * (this.now.speed ?? 1))
      field('faster').value = String(percent)
      by('percent').textContent = `${percent} %`
    } else if (told.event === 'seen') {
      this.seen = told
    } else if (told.event === 'looks') {
      this.looks = told.state
    } else if (told.event === 'fault') {
      this.#say(`${told.code}: ${told.message}`)
    } else if (told.event === 'lost') {
      this.#know()
      this.#say(told.dark ? 'The page that operates it is not heard: stopped, dark.' : 'The page that operates it is not heard: it pauses.')
    } else if (told.event === 'point') {
      this.point = told
      this.hooks.mark([told.x_mm / 1000, told.y_mm / 1000])
    } else if (told.event === 'state') {
      this.state = told.to
      // the tick that came to rest had its gate shut
      if (!ON.includes(told.to)) {
        this.now = { ...this.now, gate: false }
        this.#place()
      }
      if (told.to === 'stopped' && this.mine && performance.now() > this.knows) this.#say('Somebody else stopped it.')
      // what was wrong before is over
      if (ON.includes(told.to) || told.to === 'armed') this.#say('')
    }
    this.#show()
  }

  /** Shows on the wall how far it is. */
  #place() {
    const { now } = this
    if (this.framing || !(now.of_s > 0)) this.hooks.at(-1, false, 0)
    else if (this.mode === 'trace') this.hooks.at(now.of_s - now.plan_s, now.gate, now.of_s)
    else if (this.mode === 'step' && now.stroke) this.hooks.stroke(now.stroke, now.plan_s / now.of_s, now.gate)
    else this.hooks.at(-1, false, 0)
  }

  /** @param {string} text */
  #say(text) {
    by('said').textContent = text
    by('said').hidden = text === ''
  }

  /** What was told long ago says nothing of now. */
  #stale() {
    if ((this.on || this.follows) && performance.now() - this.heard > STALE) this.hooks.lamp('? Unknown', false)
  }

  /** Where it is, in words. */
  #where() {
    const { now, point } = this
    if (this.mine && ['ready', 'stopped'].includes(this.state)) return `Hold the left one for a second, then ${this.state === 'ready' ? 'Trace' : 'Go on'} within ten.`
    if (this.framing) return 'The frame, again and again'
    if (this.mode === 'points') return point ? `${point.kind} ${point.point} of ${point.points} · ${plain(point.x_mm, 0)}, ${plain(point.y_mm, 0)} mm` : ''
    const stroke = now.strokes > 0 && now.stroke ? `stroke ${now.stroke} of ${now.strokes}` : ''
    const of = this.rest && now.strokes > 0 ? ' of the rest' : ''
    const at = now.of_s > 0 && this.mode === 'trace' ? `${time(now.plan_s)} of ${time(now.of_s)}` : ''
    return [stroke + of, at].filter(Boolean).join(' · ')
  }

  /** What a camera sees of it, in words. */
  #sight() {
    const { seen, looks } = this
    if (looks === 'begun') return 'Something is off. The camera looks into it in the dark, and by dots of light where it has to; then the job goes on by itself. Stop ends that.'
    if (looks === 'stopped') return 'Stopped, dark. Hold to arm, then Go on: the camera looks again.'
    return seen ? `The camera sees the spot ${plain(seen.rms_mm, 2)} mm off, rms, the last time ${plain(seen.off_mm, 2)} mm; ${seen.images} images` : ''
  }

  #show() {
    by('seen-now').textContent = this.#sight()
    by('seen-now').hidden = this.#sight() === ''
    // what was so before light need not be so after a fault
    by('checks').hidden = this.looks !== 'over' || ['fault', 'unhomed'].includes(this.state)
    const { state, now, on, mine } = this
    const is_on = ON.includes(state)
    const armed = state === 'armed'
    const begins = ['ready', 'unhomed', 'armed', ''].includes(state) && !(now.plan_s > 0)
    const lit = on && now.gate === true
    by('before').hidden = on
    by('during').hidden = !on
    document.body.classList.toggle('drawing', on)
    if (!on) return
    // what is told of the one before is no news of this one
    by('attended').hidden = true
    const left = armed ? ` ${Math.ceil(now.armed_s ?? 0)} s` : ''
    this.hooks.lamp(lit ? '☀ Light' : armed ? `◔ Armed${left}` : '● Dark', lit)
    by('state').textContent = state === 'tracing' && !lit ? 'Traces: a dark move' : (STATES[state] ?? 'Begins')
    by('where').textContent = this.#where()
    const can_arm = ['ready', 'stopped', 'unhomed', 'done'].includes(state) || (state === 'paused')
    const goes = armed || state === 'paused' || this.framing
    enable('arm', mine && can_arm)
    by('arm').classList.toggle('is', armed)
    by('arm').textContent = armed ? `◔ Armed${left}` : 'Hold to arm'
    enable('go', mine && goes)
    by('go').textContent = this.framing && !armed ? '▶ Draw it now' : begins && !this.framing ? '▶ Trace' : '▶ Go on'
    enable('pause', mine && is_on && state !== 'pausing')
    enable('pause-now', mine && is_on)
    for (const id of ['next', 'previous', 'skip']) {
      by(id).hidden = this.mode === 'trace'
      enable(id, mine && (is_on || state === 'paused'))
    }
    by('clear').hidden = state !== 'fault'
    enable('clear', mine)
    enable('end', mine)
    enable('faster', mine)
    if (document.activeElement !== by('faster') && now.speed) {
      field('faster').value = String(Math.round(100 * now.speed))
      by('percent').textContent = `${plain(100 * now.speed, 0)} %`
    }
    by('viewer').hidden = mine
    by('take').hidden = !this.operates
    by('viewer-words').textContent = this.operates ? 'Another page operates it. You may stop it.' : 'This device looks on. You may stop it.'
  }
}

/** @param {string} id @param {boolean} can */
function enable(id, can) {
  // keys that are pressed after it are not its own any more
  if (!can && document.activeElement === by(id)) by(id).blur()
  by(id).toggleAttribute('disabled', !can)
}

/** A line of what was looked at before light. @param {{ name: string, verdict: string, words: string }} of */
function check(of) {
  const mark = { passed: '✓', warned: '⚠', refused: '✕' }[of.verdict] ?? '?'
  return element('li', { class: of.verdict }, element('span', { class: 'mark', text: mark, 'aria-label': of.verdict }), element('span', { text: asLabelled(of.words) }))
}
