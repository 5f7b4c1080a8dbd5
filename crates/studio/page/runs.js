// @ts-check
/** Runs that were. */

import { discard, restore, runFile, runs } from './api.js'
import { by, element } from './dom.js'
import { isCamera, length, named, plain, size, time } from './words.js'

/**
 * @typedef {import('./api.js').RunTold} RunTold
 * @typedef {{ again: (run: RunTold) => void, rest: (run: RunTold) => void, from: (run: RunTold, stroke: number) => void, problem: (error: unknown) => void, operates: boolean }} Hooks
 *   places the drawing of a run again; goes on with one; begins at a stroke of it; what went wrong; whether this device may do that
 */

/** The list of runs, the newest first. */
export class Runs {
  /** @param {Hooks} hooks */
  constructor(hooks) {
    this.hooks = hooks
    /** @type {string[]} runs that are to be compared */
    this.chosen = []
    /** @type {string | null} what was put into the trash last, by its name there */
    this.deleted = null
    by('undelete').addEventListener('click', () => this.#undelete())
  }

  /** @param {string} folder */
  async show(folder) {
    const all = await runs()
    this.hooks.problem(null)
    by('runs-where').textContent = all.length === 0 ? 'There are none yet: trace a picture.' : `They lie in ${folder}/runs, the newest first.`
    this.chosen = this.chosen.filter((id) => all.some((run) => run.id === id))
    by('run-list').replaceChildren(...all.reverse().map((run) => this.#card(run)))
    this.folder = folder
    this.#both()
  }

  /** @param {RunTold} run */
  #card(run) {
    const { id, hooks } = { id: run.id, hooks: this.hooks }
    const card = element(
      'li',
      {},
      element('img', { src: runFile(id, 'trace.png'), alt: '', loading: 'lazy' }),
      element('div', { class: 'about' }, element('h3', { text: id }), element('p', { class: 'under', text: when(run.begun) }), ...figures(run).map((text) => element('p', { text: text.replace(/(\d) (m|cm|mm|s|min)\b/g, '$1\u00a0$2') }))),
    )
    const acts = element('div', { class: 'acts' })
    if (run.files.some((file) => file.name === 'report.html')) acts.append(element('a', { class: 'plain', href: runFile(id, 'report.html'), target: '_blank', rel: 'noopener', text: 'Report', 'aria-label': `Report: ${id}` }))
    if (hooks.operates) {
      if (run.left) acts.append(act('Go on', `Go on: ${id}`, () => hooks.rest(run)))
      if (run.picture) acts.append(act('Place again', `Place again: ${id}`, () => hooks.again(run)))
      // of a rest strokes have other numbers
      const is_whole = !run.went_on_in && !run.goes_on_with && run.mode === 'trace' && !isCamera(run.picture ?? '')
      if (run.picture && run.progress && !run.finished && run.progress.stroke > 1 && is_whole) acts.append(act(`From stroke ${run.progress.stroke}`, `From stroke ${run.progress.stroke}: ${id}`, () => hooks.from(run, run.progress?.stroke ?? 1)))
    }
    const compare = act('Compare', `Compare: ${id}`, () => this.#choose(id))
    compare.setAttribute('aria-pressed', String(this.chosen.includes(id)))
    compare.dataset.run = id
    acts.append(compare)
    if (hooks.operates && !run.running) acts.append(act('Delete', `Delete: ${id}`, () => this.#delete(id)))
    const files = element('ul', { class: 'files' }, ...run.files.map((file) => element('li', {}, element('a', { href: runFile(id, file.name), download: `${id}-${file.name}`, text: file.name }), ` ${size(file.bytes)}`)))
    card.append(acts, element('details', {}, element('summary', { text: `${run.files.length} files` }), files))
    return card
  }

  /** @param {string} id */
  #choose(id) {
    const is = this.chosen.includes(id)
    // of three the oldest choice gives way
    this.chosen = is ? this.chosen.filter((other) => other !== id) : [...this.chosen, id].slice(-2)
    this.#both()
  }

  #both() {
    for (const button of by('run-list').querySelectorAll('button[aria-pressed]')) button.setAttribute('aria-pressed', String(this.chosen.includes(/** @type {HTMLElement} */ (button).dataset.run ?? '')))
    const [first, second] = this.chosen
    by('both').hidden = !first
    const words = by('both').querySelector('span')
    if (words) words.textContent = second ? `${first} and ${second}` : `${first}: choose another one to compare it with`
    by('to-compare').toggleAttribute('hidden', !second)
    by('to-compare').setAttribute('href', second ? `#compare=${first},${second}` : '#runs')
  }

  /** @param {string} id */
  async #delete(id) {
    try {
      this.deleted = await discard('runs', id)
      await this.show(this.folder ?? '')
      this.#tell(`${id} is in the trash of the studio’s folder.`)
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  async #undelete() {
    if (this.deleted === null) return
    try {
      await restore('runs', this.deleted)
      this.deleted = null
      this.#tell('')
      await this.show(this.folder ?? '')
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  /** @param {string} text */
  #tell(text) {
    by('deleted').hidden = text === ''
    const words = by('deleted').querySelector('span')
    if (words) words.textContent = text
  }
}

/** @param {string} text @param {string} label @param {() => void} done */
function act(text, label, done) {
  const button = element('button', { type: 'button', class: 'plain', text, 'aria-label': label })
  button.addEventListener('click', done)
  return button
}

/** A time as people here write it. @param {string} begun */
function when(begun) {
  const at = new Date(begun)
  return Number.isNaN(at.getTime()) ? begun : at.toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' })
}

/** What a run came to, a line each. @param {RunTold} run */
function figures(run) {
  const { progress } = run
  const strokes = run.points ? '' : `, ${run.strokes} strokes`
  const lines = [`${length(run.width_m)} × ${length(run.height_m)}${strokes}${run.duration_s ? `, ${time(run.duration_s)}` : ''}`]
  if (run.running) lines.push('It is being drawn now.')
  else if (run.went_on_in) lines.push(`Went on in ${named(run.went_on_in)}.`)
  else if (run.points) lines.push(`${run.points.done} of ${run.points.count} points marked.`)
  else if (run.mode === 'step') lines.push('Stroke by stroke.')
  else if (!run.finished) lines.push(progress ? `Ended at stroke ${progress.stroke} of ${progress.strokes}.` : 'Ended before it began.')
  if (run.goes_on_with) lines.push(`The rest of ${named(run.goes_on_with)}.`)
  if (run.finished && run.max_mm !== null) lines.push(`${plain(run.max_mm, 2)} mm off at most`)
  return lines
}
