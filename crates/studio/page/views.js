// @ts-check
/** Views of the page: which there are, and which one the address names. What the first view does not need comes when somebody goes there. */

import { by, once } from './dom.js'

/** Views with a link of their own. */
const LINKED = ['place', 'run', 'runs', 'lab', 'rigs', 'cameras', 'devices']
/** Those that come when somebody goes there. */
const LATER = ['runs', 'compare', 'lab', 'rigs', 'cameras', 'devices']

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {{ told: (where: string, error: unknown) => void, flags: () => Flags, use: (flags: Flags) => void, place: (picture: string, calibration: string) => void, ownRigs: () => void, calibrated: (all: import('./api.js').Calibration[]) => void, again: (of: import('./api.js').RunTold, view: string) => void, run: import('./run.js').Run, folder: () => string, entered: (attends: boolean) => void, outside: boolean, operates: boolean }} Hooks
 */

export class Views {
  /** @param {Hooks} hooks */
  constructor(hooks) {
    this.hooks = hooks
    this.shown = ''
    const problem = (/** @type {string} */ where) => (/** @type {unknown} */ error) => hooks.told(where, error)
    const { operates } = hooks
    this.markup = once(markup)
    this.runs = once(async () => new (await import('./runs.js')).Runs({
      again: (of) => hooks.again(of, '#place'),
      rest: (of) => {
        hooks.again(of, '#run')
        hooks.run.goOnWith(of)
      },
      from: (of, stroke) => {
        hooks.again(of, '#run')
        hooks.run.from(stroke)
      },
      problem: problem('runs-problem'),
      operates,
    }))
    this.lab = once(async () => new (await import('./lab.js')).Lab(problem('lab-problem')))
    this.devices = once(async () => new (await import('./devices.js')).Devices(problem('devices-problem')))
    this.rigs = once(async () => new (await import('./rigs.js')).Rigs({ problem: problem('rigs-problem'), use: (rig) => hooks.use({ rig }), changed: hooks.ownRigs, operates }))
    this.cameras = once(async () => new (await import('./cameras.js')).Cameras({ problem: problem('cameras-problem'), place: hooks.place, use: hooks.use, changed: hooks.calibrated, flags: hooks.flags, operates }))
  }

  /** Shows the view that the address names. */
  show() {
    const [named, more] = location.hash.slice(1).split('=')
    const is = this.hooks.outside ? 'outside' : LINKED.includes(named) || named === 'compare' ? named : 'place'
    const attends = is === 'run'
    by('place').hidden = is !== 'place' && !attends
    by('outside').hidden = is !== 'outside'
    by('placing').hidden = attends
    by('attend').hidden = !attends
    document.body.classList.toggle('attending', attends)
    this.hooks.entered(attends)
    const current = is === 'compare' ? 'runs' : is
    for (const id of LINKED) {
      if (id === current) by(`to-${id}`).setAttribute('aria-current', 'page')
      else by(`to-${id}`).removeAttribute('aria-current')
    }
    if (is !== this.shown) scrollTo(0, 0)
    const was = this.shown
    this.shown = is
    if (LATER.includes(is) || LATER.includes(was)) this.markup().then(() => this.#later(is, was, more ?? ''), (error) => this.hooks.told('problem', error))
  }

  /** Shows one of the views that come later, or leaves them. @param {string} is @param {string} was @param {string} more what of it */
  #later(is, was, more) {
    // somebody went on while it came
    if (is !== this.shown) return
    for (const id of LATER) by(id).hidden = is !== id
    const told = (/** @type {string} */ where) => (/** @type {unknown} */ error) => this.hooks.told(where, error)
    if (is === 'devices' || was === 'devices') this.devices().then((view) => view.show(is === 'devices')).catch(told('devices-problem'))
    if (is === 'cameras' || was === 'cameras') this.cameras().then((view) => view.show(is === 'cameras', more)).catch(told('cameras-problem'))
    if (is === 'lab') this.lab().then((view) => view.show(more)).catch(told('lab-problem'))
    if (is === 'rigs') this.rigs().then((view) => view.show(more)).catch(told('rigs-problem'))
    if (is === 'runs') this.runs().then((view) => view.show(this.hooks.folder())).catch(told('runs-problem'))
    if (is === 'compare') {
      const [first, second] = decodeURIComponent(more).split(',')
      import('./compare.js').then((view) => view.showCompared(first, second)).then(() => this.hooks.told('compare-problem', null), told('compare-problem'))
    }
  }
}

/** Fetches the views that come later, and how they look. */
async function markup() {
  const style = document.createElement('link')
  style.rel = 'stylesheet'
  style.href = '/page/views.css'
  const styled = new Promise((done, failed) => {
    style.addEventListener('load', done)
    style.addEventListener('error', () => failed(new Error('the studio’s server does not answer: is it still running in its terminal?')))
  })
  document.head.append(style)
  const [text] = await Promise.all([page(), styled])
  by('outside').before(...new DOMParser().parseFromString(text, 'text/html').body.children)
}

/** Their elements, as text. */
async function page() {
  const response = await fetch('/page/views.html')
  if (!response.ok) throw new Error(`the studio’s server has no such page: it answers ${response.status}`)
  return response.text()
}
