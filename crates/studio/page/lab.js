// @ts-check
/** The lab: experiments of a command line each, with its plot, figures and words; lessons with questions that the simulator grades. */

import * as api from './api.js'
import { by, element, once } from './dom.js'

/** How long what is typed rests before it is asked, ms. */
const REST = 200

/**
 * @typedef {{ flag: string, label: string, value?: string, hint?: string, choices?: [string, string][], check?: boolean, slide?: [number, number, number] }} Field
 *   a slide from, to, by: its value goes into the flag `gains` by its name
 * @typedef {{ command: string, name: string, words: string, systems?: string, fields: Field[], waits?: boolean }} Experiment one that takes seconds waits for a button
 */

/** @type {[string, string][]} */
const LAWS = [['', 'the head’s own'], ['hand-tuned', 'PID tuned by hand'], ['state', 'state feedback'], ['pid-ff', 'PID with feedforward'], ['pid', 'PID'], ['lead-lag', 'lead-lag'], ['report-zpk', 'the report’s, poles and zeros'], ['report-tc', 'the report’s, time constants'], ['report-pd', 'the report’s PD']]
const FORMULA = 'a formula in s; G11, G22: the head, pan and tilt; K11, K22: the 2006 report’s compensators; several with ; between'

/** @type {Experiment[]} */
const EXPERIMENTS = [
  {
    command: 'step', name: 'Step of a joint', words: 'From rest to an angle, on the head with its friction and its motors’ limits, and linearized. Tuned by hand its gains follow the sliders.',
    fields: [
      { flag: 'axis', label: 'Joint', choices: [['', 'pan'], ['tilt', 'tilt']] },
      { flag: 'to', label: 'To', value: '15deg', hint: '15deg' },
      { flag: 'law', label: 'Law', choices: LAWS, value: 'hand-tuned' },
      { flag: 'kp', label: 'kp, N m/rad', slide: [1, 120, 1], value: '20' },
      { flag: 'ki', label: 'ki, N m/(rad s)', slide: [0, 200, 5], value: '0' },
      { flag: 'kd', label: 'kd, N m s/rad', slide: [0, 10, 0.1], value: '1' },
      { flag: 'reference', label: 'It is told', choices: [['', 'as the law is meant'], ['jump', 'at once'], ['move', 'as fast as the limits allow']] },
      { flag: 'rig', label: 'Head', choices: [['', 'report'], ['worn', 'worn'], ['bridge', 'bridge']] },
    ],
  },
  { command: 'bode', name: 'Bode', words: 'Gain and phase over frequency, with margins.', systems: 'K11*G11', fields: [{ flag: 'closed', label: 'Of the closed loop', check: true }] },
  { command: 'nyquist', name: 'Nyquist', words: 'The open loop around −1, with margins.', systems: 'K11*G11', fields: [] },
  { command: 'nichols', name: 'Nichols', words: 'Gain over phase of the open loop, with contours of the closed one.', systems: 'K11*G11', fields: [] },
  { command: 'locus', name: 'Root locus', words: 'Where the poles of the closed loop go as the gain k rises. Drag a closed pole along its branch, or the slider: damping and step follow.', systems: 'K11*G11', fields: [{ flag: 'damping', label: 'Gain for a damping of', hint: '0.7' }] },
  { command: 'pzmap', name: 'Poles and zeros', words: 'With natural frequency and damping of each.', systems: 'G11', fields: [{ flag: 'closed', label: 'Of the closed loop', check: true }] },
  { command: 'response', name: 'Response', words: 'Of linear systems, to a step, an impulse or a ramp.', systems: '1/(s^2+0.4s+1)', fields: [{ flag: 'input', label: 'Input', choices: [['', 'step'], ['impulse', 'impulse'], ['ramp', 'ramp']] }, { flag: 'duration', label: 'For', hint: '20s' }, { flag: 'closed', label: 'Of the closed loop', check: true }] },
  {
    command: 'design pid', name: 'Design a PID', words: 'The largest gain that keeps a phase margin, at a crossover; with its loop’s margins, its step and its poles.', systems: 'G11',
    fields: [
      { flag: 'type', label: 'Type', choices: [['', 'PID'], ['p', 'P'], ['pi', 'PI'], ['pd', 'PD']] },
      { flag: 'crossover', label: 'Crossover', value: '60rad/s', hint: '60rad/s' },
      { flag: 'phase_margin', label: 'Phase margin', hint: '55deg' },
      { flag: 'overshoot', label: 'Overshoot at most, %', hint: '5' },
    ],
  },
  {
    command: 'tune', name: 'Tune the head', words: 'Law and bandwidth with the smallest error over heads that differ, among those that bear a gain half as large again and a current that comes late.', waits: true,
    fields: [
      { flag: 'shape', label: 'It draws', choices: [['', 'a circle'], ['line', 'a line']] },
      { flag: 'laws', label: 'Laws', hint: 'all of them' },
      { flag: 'gain_margin', label: 'Gain margin', hint: '1.5' },
      { flag: 'plants', label: 'Heads', hint: '12' },
      { flag: 'speed', label: 'Speed', hint: '1ft/s' },
      { flag: 'rig', label: 'Head', choices: [['', 'report'], ['worn', 'worn'], ['bridge', 'bridge']] },
    ],
  },
  {
    command: 'montecarlo', name: 'Monte Carlo', words: 'The same drawn on many heads whose parameters vary: the middle one, 95 of 100, the worst.', waits: true,
    fields: [
      { flag: 'plants', label: 'Heads', hint: '60' },
      { flag: 'shape', label: 'They draw', choices: [['', 'a circle'], ['line', 'a line']] },
      { flag: 'law', label: 'Law', choices: LAWS },
      { flag: 'laps', label: 'Laps, learning between', hint: '1' },
      { flag: 'speed', label: 'Speed', hint: '1ft/s' },
      { flag: 'rig', label: 'Head', choices: [['', 'report'], ['worn', 'worn'], ['bridge', 'bridge']] },
    ],
  },
  {
    command: 'relay', name: 'Relay', words: 'A relay lets a joint swing; how it swings tells gains, without a model.',
    fields: [
      { flag: 'axis', label: 'Joint', choices: [['', 'pan'], ['tilt', 'tilt']] },
      { flag: 'level', label: 'Voltage', hint: '4V' },
      { flag: 'phase_margin', label: 'Phase margin', hint: '55deg' },
      { flag: 'rig', label: 'Head', choices: [['', 'report'], ['worn', 'worn'], ['bridge', 'bridge']] },
    ],
  },
  {
    command: 'profile', name: 'Motion profiles', words: 'A joint from rest to rest, motors left out: durations and peaks of every profile.',
    fields: [
      { flag: 'distance', label: 'Way', hint: '180deg' },
      { flag: 'vmax', label: 'Speed at most', hint: '2rad/s' },
      { flag: 'amax', label: 'Acceleration at most', hint: '20rad/s2' },
    ],
  },
  { command: 'gang', name: 'Gang of four', words: 'What a loop lets through: its sensitivities, with their peaks.', systems: 'G11', fields: [{ flag: 'controller', label: 'Controller', value: 'K11', hint: 'K11' }] },
]
const LESSONS = 8

export class Lab {
  /** @param {(error: unknown) => void} problem */
  constructor(problem) {
    this.problem = problem
    this.timer = 0
    this.locus = once(async () => new (await import('./locus.js')).Locus(by('lab-drag'), problem))
    by('lab-form').addEventListener('submit', (event) => event.preventDefault())
    this.number = 0
    this.before = new AbortController()
    this.address = ''
    /** @type {Map<string, HTMLInputElement | HTMLSelectElement>} */
    this.inputs = new Map()
    const link = (/** @type {string} */ to, /** @type {string} */ text) => element('li', {}, element('a', { href: `#lab=${to}`, text }))
    by('lab-list').append(...EXPERIMENTS.map(({ command, name }) => link(address(command), name)))
    by('lesson-list').append(...Array.from({ length: LESSONS }, (_, n) => link(`lesson-${n + 1}`, `Lesson ${n + 1}`)))
    by('lab-copy').addEventListener('click', () => navigator.clipboard?.writeText(by('lab-command').textContent ?? ''))
  }

  /** Shows an experiment, or a lesson. @param {string} named */
  show(named) {
    const [, lesson] = /^lesson-([1-8])$/.exec(named) ?? []
    const experiment = EXPERIMENTS.find(({ command }) => address(command) === named) ?? EXPERIMENTS[0]
    this.#progress()
    for (const link of document.querySelectorAll('#lab nav a')) {
      if (link.getAttribute('href') === `#lab=${lesson ? named : address(experiment.command)}`) link.setAttribute('aria-current', 'page')
      else link.removeAttribute('aria-current')
    }
    this.problem(null)
    this.inputs.clear()
    by('lab-form').replaceChildren()
    if (!by('lab-drag').hidden) this.locus().then((view) => view.leave(), () => {})
    by('lab-drag').hidden = true
    by('lab-plot').replaceChildren()
    by('lab-words').textContent = by('lab-command').textContent = ''
    by('lab-text').replaceChildren()
    by('lab').classList.toggle('learns', lesson !== undefined)
    if (lesson) this.#lesson(lesson)
    else this.#experiment(experiment)
  }

  /** @param {Experiment} of */
  #experiment(of) {
    by('lab-title').textContent = of.name
    by('lab-about').textContent = of.words
    const ask = () => this.#soon(() => this.#asked(of))
    if (of.systems !== undefined) this.#field({ flag: 'systems', label: 'System', value: of.systems, hint: FORMULA }, ask)
    for (const field of of.fields) this.#field(field, of.waits ? () => {} : ask)
    if (!of.waits) return void this.#ask(this.#asked(of))
    const button = element('button', { type: 'button', class: 'go', text: 'Calculate' })
    button.addEventListener('click', async () => {
      button.setAttribute('disabled', '')
      by('lab-words').textContent = 'It calculates…'
      const told = await this.#ask(this.#asked(of))
      button.removeAttribute('disabled')
      if (told?.rig) by('lab-form').append(this.#kept(told.rig))
    })
    by('lab-form').append(button)
  }

  /** Lets a rig that was found be kept as a file. @param {string} toml */
  #kept(toml) {
    by('keep-rig')?.remove()
    const button = element('button', { type: 'button', class: 'plain', id: 'keep-rig', text: 'Keep it as a rig file' })
    button.addEventListener('click', async () => {
      try {
        const names = (await api.rigs()).map(({ name }) => name)
        let name = 'tuned.toml'
        for (let n = 2; names.includes(name); n++) name = `tuned-${n}.toml`
        await api.writeRig(name, toml, { before: '' })
        location.hash = `#rigs=${name}`
      } catch (error) {
        this.problem(error)
      }
    })
    return button
  }

  /** Marks the lessons that were passed. */
  async #progress() {
    const passed = await api.lessons().catch(() => /** @type {number[]} */ ([]))
    for (let n = 1; n <= LESSONS; n++) {
      const link = document.querySelector(`#lesson-list a[href="#lab=lesson-${n}"]`)
      if (link) link.textContent = `Lesson ${n}${passed.includes(n) ? ' ✓' : ''}`
    }
  }

  /** @param {Field} field @param {() => void} changed */
  #field(field, changed) {
    const { flag, label, choices, check, slide, value, hint } = field
    const input = choices ? document.createElement('select') : document.createElement('input')
    for (const [choice, words] of choices ?? []) input.append(new Option(words, choice))
    const shown = element('span', { text: label })
    if (input instanceof HTMLInputElement) {
      input.type = check ? 'checkbox' : slide ? 'range' : 'text'
      if (slide) [input.min, input.max, input.step] = slide.map(String)
      if (!check && !slide) input.spellcheck = false
      if (hint && hint.length < 20) input.placeholder = hint
    }
    if (flag === 'rig') {
      // beside presets the folder's own
      api.rigs().then((all) => input.append(...all.filter((rig) => rig.own && !rig.problem).map(({ name }) => new Option(name, name))), () => {})
    }
    if (value !== undefined) input.value = value
    input.name = flag
    const told = () => slide && (shown.textContent = `${label}: ${input.value}`)
    told()
    input.addEventListener('input', () => {
      told()
      changed()
    })
    this.inputs.set(flag, input)
    const row = element('label', { class: `row${check ? ' check' : slide || flag === 'systems' ? ' wide' : ''}` }, shown, input)
    by('lab-form').append(row)
    if (hint && hint.length >= 20) by('lab-form').append(element('p', { class: 'under', text: hint }))
  }

  /** What is asked by the fields as they are. @param {Experiment} of */
  #asked(of) {
    /** @type {api.Flags} */
    const flags = {}
    const value = (/** @type {string} */ flag) => this.inputs.get(flag)?.value.trim() ?? ''
    const by_hand = value('law') === 'hand-tuned'
    for (const field of of.fields) {
      const input = this.inputs.get(field.flag)
      if (field.slide) input?.closest('label')?.toggleAttribute('hidden', !by_hand)
      else if (field.check) flags[field.flag] = /** @type {HTMLInputElement} */ (input).checked
      else flags[field.flag] = value(field.flag)
    }
    if (by_hand) flags.gains = `kp=${value('kp')},ki=${value('ki')},kd=${value('kd')}`
    const systems = value('systems').split(';').map((one) => one.trim()).filter(Boolean)
    return { command: of.command, of: systems, flags }
  }

  /** @param {() => { command: string, of: string[], flags: api.Flags }} asked */
  #soon(asked) {
    clearTimeout(this.timer)
    this.timer = window.setTimeout(() => this.#ask(asked()), REST)
  }

  /** @param {{ command: string, of: string[], flags: api.Flags }} asked @returns {Promise<api.Experiment | null>} */
  async #ask(asked) {
    const number = ++this.number
    // what was asked before is wanted no more, and ends
    this.before.abort()
    this.before = new AbortController()
    try {
      const told = await api.experiment(asked, this.before.signal)
      // somebody asks for another by now
      if (number !== this.number) return null
      this.problem(null)
      this.#plot(told)
      await this.#dragged(asked, told)
      if (number !== this.number) return null
      by('lab-words').textContent = told.words
      by('lab-command').textContent = told.command
      return told
    } catch (error) {
      if (number === this.number) {
        this.problem(error)
        by('lab-words').textContent = by('lab-command').textContent = ''
      }
      return null
    }
  }

  /** Lets the poles of a root locus be dragged; of the first of several. @param {{ command: string, of: string[] }} asked @param {api.Experiment} told */
  async #dragged(asked, told) {
    const [found] = asked.command === 'locus' ? told.answer.systems : []
    by('lab-drag').hidden = !found
    if (found) (await this.locus()).show(found, asked.of[0])
  }

  /** @param {api.Experiment} told */
  #plot(told) {
    URL.revokeObjectURL(this.address)
    if (told.svg === '') return by('lab-plot').replaceChildren()
    this.address = URL.createObjectURL(new Blob([told.svg], { type: 'image/svg+xml' }))
    by('lab-plot').replaceChildren(element('img', { src: this.address, alt: `Plot of ${told.command}` }))
  }

  /** @param {string} number */
  async #lesson(number) {
    by('lab-title').textContent = `Lesson ${number}`
    by('lab-about').textContent = ''
    const told = await this.#ask({ command: 'lesson', of: [number], flags: {} })
    if (!told) return
    by('lab-words').textContent = ''
    const { text, asks } = /** @type {{ text: string, asks: { name: string, meaning: string, unit: string }[] }} */ (told.answer)
    const [title, ...rest] = blocks(text)
    by('lab-title').textContent = title.replace(/^#+ /, '')
    by('lab-text').replaceChildren(...rest.map(paragraph))
    for (const ask of asks) this.#field({ flag: ask.name, label: `${ask.name}, ${ask.unit}`, hint: '' }, () => {})
    const button = element('button', { type: 'button', class: 'go', text: 'Check my answer' })
    button.addEventListener('click', async () => {
      const given = asks.map(({ name }) => `${name}=${this.inputs.get(name)?.value.trim().replace(',', '.')}`).join(',')
      const graded = await this.#ask({ command: 'lesson', of: [number], flags: { answer: given } })
      if (graded) by('lab-verdict').replaceChildren(...verdict(graded))
      this.#progress()
    })
    by('lab-form').append(...asks.map((ask) => element('p', { class: 'under', text: `${ask.name}: ${ask.meaning}` })), button, element('div', { id: 'lab-verdict', class: 'stack', role: 'status' }))
  }
}

/** How the address names an experiment. @param {string} command */
const address = (command) => command.replace(' ', '-')

/** The paragraphs of a lesson; what is set apart stays together, with its empty lines. @param {string} text */
function blocks(text) {
  /** @type {string[]} */
  const all = []
  for (const part of text.split('\n\n')) {
    const last = all.at(-1) ?? ''
    const is_open = (last.match(/^```/gm)?.length ?? 0) % 2 === 1
    const is_more = /^ {4}/.test(last) && /^ {4}/.test(part)
    if (is_open || is_more) all[all.length - 1] = `${last}\n\n${part}`
    else all.push(part)
  }
  return all
}

/** A paragraph of a lesson. @param {string} text */
function paragraph(text) {
  // the picture of what its experiment shows is plotted there
  if (text.startsWith('![')) return element('span')
  if (text.startsWith('#')) return element('h3', { text: text.replace(/^#+ /, '') })
  if (/^( {4}|```)/.test(text)) return element('pre', { text: text.replace(/^```.*\n|\n?```$/g, '').replace(/^ {4}/gm, ''), tabindex: '0' })
  return element('p', { text: text.replaceAll('\n', ' ').replaceAll('`', '') })
}

/** How an answer does, a line a figure. @param {api.Experiment} graded */
function verdict(graded) {
  const figures = /** @type {{ what: string, value: number, unit: string, least: number | null, most: number | null, met: boolean, hint: string }[]} */ (graded.answer?.figures ?? [])
  const lines = figures.map((of) => {
    const value = of.value === null ? '–' : Number(of.value.toPrecision(4))
    const bounds = of.least === null || of.most === null ? '' : `, between ${Number(of.least.toPrecision(4))} and ${Number(of.most.toPrecision(4))} wanted`
    return element('p', { class: of.met ? 'met' : 'unmet', text: `${of.met ? '✓' : '✕'} ${of.what}: ${value} ${of.unit}${bounds}${of.met || !of.hint ? '' : `. ${of.hint}`}` })
  })
  return [element('p', { class: 'big', text: graded.failure === null ? '✓ Right.' : 'Not yet.' }), ...lines]
}
