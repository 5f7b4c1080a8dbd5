// @ts-check
/** The page: what is asked of whom, in which order. */

import * as api from './api.js'
import { arrive } from './arrive.js'
import { by, element, once } from './dom.js'
import { Beneath } from './beneath.js'
import { Corners } from './corners.js'
import { Dark } from './dark.js'
import { Fields, asLabelled } from './fields.js'
import { figures, noFigures } from './figures.js'
import { keep, kept, themes, units } from './kept.js'
import { follow, showResult } from './jobs.js'
import { Marks } from './marks.js'
import { Pictures } from './pictures.js'
import { boxOf, flagsOf, measuredAnew, ofWall, onWall as placedOn, planned } from './place.js'
import { Run } from './run.js'
import { Store, essence } from './store.js'
import { Timeline } from './timeline.js'
import { askUnit } from './unit.js'
import { Views } from './views.js'
import { NOWHERE, Wall } from './wall.js'
import { called, isCamera, shown } from './words.js'

/** How long a wish rests before it is planned, ms. */
const REST = 150
/** A way by an arrow key, m. */
const NUDGE_M = 1e-3
/** How often a page looks whether another one traces, ms. */
const LOOK = 1000
/** In how many seconds a drawing is played while it is traced. */
const PLAYED_S = 6

const page = crypto.randomUUID()
const session = await arrive().catch(() => null)
const operates = session?.role === 'operator'
const chosen = new URLSearchParams(location.hash.slice(1)).get('picture')
const store = new Store(chosen ? { picture: chosen, flags: {} } : earlier())
let folder = ''
/** @type {api.Head | null | undefined} the head that the studio was opened for; undefined as long as nobody has told */
let head
/** @type {api.Plan | null} */
let plan = null
/** @type {api.Flags} what it was asked by */
let planFlags = {}
let tracing = false

const wall = new Wall(by('wall'), (box, done) => {
  const flags = placed(box)
  if (done) store.flags(flags)
  else fields.show({ ...store.asked.flags, ...flags })
})
const timeline = new Timeline({ range: by('time'), play: by('play'), clock: by('clock'), rate: by('rate') }, (row) => wall.at(row))
// what is measured from another corner lies where it lay
const fields = new Fields(by('fields'), (flags) => store.flags('from' in flags ? { ...measuredAnew(store.asked.flags, { ...store.asked.flags, ...flags }, wall.box), ...flags } : flags))
const beneath = new Beneath(by('beneath'), wall)
const onWall = {
  flags: () => store.asked.flags,
  changed: (/** @type {api.Flags} */ flags) => store.flags(flags),
  ask: (/** @type {string} */ words) => {
    by('pointing').hidden = words === ''
    by('pointing-words').textContent = words
    if (words) by('wall').scrollIntoView({ block: 'nearest' })
  },
}
const marks = new Marks(wall, onWall)
const dark = new Dark(wall, onWall)
new Corners(wall, onWall, () => plan?.plan.sheet ?? null)
fields.part('width').after(by('marks'), by('dark'))
fields.part('straighten').append(by('show-corners'))
by('pointed').addEventListener('click', () => wall.cancel())

/** What was asked for when this page was last left, else what was placed last, here or on another device. @returns {import('./store.js').Asked} */
function earlier() {
  const asked = kept('sessionStorage', 'asked')
  return asked ? JSON.parse(asked) : (session?.last ?? { picture: 'house.png', flags: {} })
}

/** Where the drawing is to be by its flags. @param {api.Flags} flags @returns {import('./wall.js').Box} */
const lies = (flags) => (plan ? boxOf(flags, planned(plan), planFlags) : NOWHERE)

/** Where it was dragged, as flags. @param {import('./wall.js').Box} box */
const placed = (box) => flagsOf(box, lies(store.asked.flags), store.asked.flags)

const run = new Run(page, {
  asked: () => store.asked,
  at: (left_s, lit, of_s) => {
    wall.dark = left_s >= 0 && !lit
    // what was left out before it began is not lit
    wall.lit.from(left_s < 0 ? 0 : timeline.rowBefore(of_s))
    if (left_s < 0) timeline.rest()
    else timeline.to(left_s)
  },
  stroke: (number, share, lit) => wall.within(number, share, lit),
  mark: (at) => wall.marks(at),
  ended: (job) => showResult(by('attended'), job),
  problem,
  lamp,
  heads: () => heads(),
})

run.operates = operates
const pictures = new Pictures({ choose, chosen: () => store.asked.picture, problem, operates })
const pad = once(async () => new (await import('./head.js')).HeadPad(problem))
// what the first view does not need comes when somebody goes there
const camera = once(async () => new (await import('./camera.js')).Camera({ take: (file) => void pictures.take(file), problem }))
const views = new Views({
  told,
  flags: () => store.asked.flags,
  use: (flags) => {
    // without a head of its own the studio has the preset
    store.flags(flags.rig === 'report' && !head ? { ...flags, rig: '' } : flags)
    location.hash = '#place'
  },
  place: (picture, calibration) => {
    choose(picture)
    store.flags({ calibration })
    location.hash = '#place'
  },
  ownRigs,
  calibrated: ownHeads,
  again: (of, view) => take_up(of, view),
  run,
  folder: () => folder,
  entered: (attends) => {
    fix(attends)
    wall.cancel()
    run.modes()
  },
  outside: session?.role === null,
  operates,
})

/** What the camera sees is drawn where it is, and what somebody attends lies where it lies. @param {boolean} attends */
function fix(attends) {
  const by_camera = isCamera(store.asked.picture)
  document.body.classList.toggle('by-camera', by_camera)
  wall.fixed = attends || !operates || by_camera
  fields.name('head', by_camera ? 'where the camera finds it' : 'square-on before the middle')
}

/** Takes up what a run was asked, on the wall. @param {api.RunTold | api.Job} of @param {string} view */
function take_up(of, view) {
  if (of.picture) choose(of.picture, of.flags ?? {})
  location.hash = view
}

let asked = 0
let timer = 0
let before = new AbortController()

/** Plans what is asked for, once it rests. @param {number} [rest] */
function planSoon(rest = REST) {
  clearTimeout(timer)
  const number = ++asked
  before.abort()
  before = new AbortController()
  const { signal } = before
  document.body.classList.add('waits')
  by('trace').setAttribute('disabled', '')
  if (plan === null) by('hint').textContent = 'Planning…'
  timer = window.setTimeout(async () => {
    try {
      const { flags } = store.asked
      const made = await api.plan({ page, number, ...store.asked }, signal)
      const points = await api.points(made.points)
      if (number === asked) show(made, points, flags)
    } catch (error) {
      if (number === asked) refused(error)
    }
  }, rest)
}

/** Nothing is planned: what is shown is of nothing. */
function nothing() {
  plan = null
  wall.show(null, NOWHERE)
  details(null)
  timeline.of(0, 0)
  noFigures()
  by('remarks').hidden = true
}

/** Shows what lies on the wall beside the strokes. @param {api.PlanFigures | null} of */
function details(of) {
  marks.show(of)
  dark.show(of)
  beneath.show(store.asked.picture, isCamera(store.asked.picture) ? null : (of?.sheet ?? null))
  askUnit(of?.sheet ?? null, store.asked.flags, false, (flags) => store.flags(flags))
}

/** What was wished for cannot be planned. @param {unknown} error */
function refused(error) {
  const is_sizeless = error instanceof api.Refusal && error.failure.code === 'size-not-meant'
  if (is_sizeless) askUnit(null, store.asked.flags, true, (flags) => store.flags(flags))
  if (plan === null) by('hint').textContent = 'Nothing to show.'
  problem(error)
}

/** @param {api.Plan} made @param {api.Points} points @param {api.Flags} flags */
function show(made, points, flags) {
  problem(null)
  plan = made
  planFlags = flags
  by('hint').textContent = ''
  document.body.classList.remove('waits')
  setTracing(tracing)
  wall.show(points, planned(made))
  details(made.plan)
  timeline.of(points.rows, made.plan.plan.duration_s)
  figures(made)
  by('remarks').hidden = made.remarks.length === 0
  by('remarks').querySelector('ul')?.replaceChildren(...made.remarks.map((remark) => element('li', { text: asLabelled(remark) })))
}

/** Tells what went wrong with what is on the wall; null for nothing. @param {unknown} error */
function problem(error) {
  fields.blame(told('problem', error))
}

/** Tells what went wrong, where it arises; null for nothing. @param {string} where @param {unknown} error @returns {string} what was told */
function told(where, error) {
  const place = by(where)
  place.hidden = error === null
  place.replaceChildren()
  if (error === null) return ''
  const failure = error instanceof api.Refusal ? error.failure : { code: 'internal', message: error instanceof Error ? error.message : String(error) }
  // names without the folder that they are in
  place.append(element('strong', { text: asLabelled(failure.message).replaceAll(`${folder}/pictures/`, '').replaceAll(`${folder}/runs/`, '') }))
  // of a wrong value there is no more to be told than its message does
  if (failure.help && failure.code !== 'usage') place.append(element('p', { text: failure.help }))
  return failure.message
}

/** Traces what is shown. */
async function trace() {
  if (tracing) return
  if (run.busy()) return problem(new api.Refusal({ code: 'busy', message: 'A job is operated in Run: stop it and end it, or wait until it is done.' }, 409))
  setTracing(true)
  by('result').hidden = true
  problem(null)
  try {
    await api.trace(store.asked)
    if (plan) {
      timeline.rest()
      timeline.play(Math.max(1, plan.plan.plan.duration_s / PLAYED_S))
    }
  } catch (error) {
    problem(error)
    // another page traces: this one shows how far it is
    if (!(error instanceof api.Refusal) || error.failure.code !== 'busy') return setTracing(false)
  }
  await followed()
}

/** Follows the job in hand to its end, and shows how it ended. */
async function followed() {
  try {
    const ended = await follow((job) => lamp(`◔ ${words(job)}`))
    setTracing(false)
    // light that is not there does not go on
    if (ended?.failure) timeline.rest()
    if (ended && ended.picture === store.asked.picture) {
      showResult(by('result'), ended)
      by('result').scrollIntoView({ block: 'nearest' })
    }
  } catch (error) {
    problem(error)
    setTracing(false)
    // nobody says so any more
    lamp('? Unknown')
  }
}

/** @param {api.Job} job */
function words(job) {
  const stage = /** @type {Record<string, string>} */ ({ strokes: 'Finding strokes', plan: 'Planning', run: 'Tracing', report: 'Writing the report' })[job.stage] ?? 'Tracing'
  return job.of > 1 ? `${stage} ${Math.round((100 * job.done) / job.of)} %` : stage
}

/** @param {boolean} is */
function setTracing(is) {
  tracing = is
  // what cannot be planned cannot be traced
  by('trace').toggleAttribute('disabled', is || !operates || plan === null || document.body.classList.contains('waits'))
  if (!is) lamp('● Dark')
}

/** What light there is, as far as it is known. @param {string} text @param {boolean} [lit] */
function lamp(text, lit = false) {
  const place = by('lamp')
  if (place.textContent !== text) place.textContent = text
  place.classList.toggle('lit', lit)
  place.classList.toggle('unknown', text.startsWith('?'))
  document.body.classList.toggle('lit', lit)
}

async function stop() {
  by('stop').classList.add('pressed')
  // by both ways: whichever is quicker
  run.stop()
  try {
    await api.stop()
  } catch (error) {
    problem(error)
  }
  setTimeout(() => by('stop').classList.remove('pressed'), 300)
}

/** Puts a picture on the wall. @param {string} picture @param {api.Flags} [flags] */
function choose(picture, flags) {
  const { picture: was, flags: asked } = store.asked
  const remembered = (/** @type {string} */ name) => JSON.parse(kept('sessionStorage', name) ?? 'null')
  // what a camera sees has no place to be given: the wall is as it was before
  const { distance, head, rig } = asked
  const on_wall = ofWall(isCamera(was) ? { ...remembered('wall'), distance, head, rig } : asked)
  const before = /** @type {Record<string, api.Flags>} */ ({ ...remembered('placed'), [was]: asked })
  keep('sessionStorage', 'wall', JSON.stringify(on_wall))
  keep('sessionStorage', 'placed', JSON.stringify(before))
  // what was asked of one picture is not asked of another, but what is of the wall and the head
  const next = { picture, flags: flags ?? (isCamera(picture) ? ofWall({ distance, head, rig }) : placedOn(before[picture], on_wall)) }
  if (next.picture === store.asked.picture && essence(next.flags) === essence(store.asked.flags)) return
  problem(null)
  wall.cancel()
  nothing()
  wall.first = true
  run.anew()
  store.set(next)
}

/** @param {KeyboardEvent} event */
function key(event) {
  if (event.key === 'Escape') {
    wall.cancel()
    return void stop()
  }
  const target = /** @type {HTMLElement} */ (event.target)
  const types = target.closest('input:not([type=range]), select, textarea') !== null
  const letter = event.key.toLowerCase()
  if ((event.ctrlKey || event.metaKey) && !types && (letter === 'z' || letter === 'y')) {
    // a browser would undo what was typed, and go there
    event.preventDefault()
    return letter === 'y' || event.shiftKey ? store.redo() : store.undo()
  }
  if (types || event.ctrlKey || event.metaKey || event.altKey) return
  if (location.hash === '#run' && !target.closest('button, summary, a, input') && run.key(event)) return event.preventDefault()
  if (event.key === ' ' && location.hash !== '#run' && !target.closest('button, summary, a')) {
    event.preventDefault()
    timeline.toggle()
  }
  if (target !== by('wall')) return
  if (wall.fixed && event.key.startsWith('Arrow')) return
  const ways = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] })
  const way = ways[event.key]
  if (way) {
    event.preventDefault()
    const by_m = NUDGE_M * (event.shiftKey ? 10 : 1)
    const { x, y } = wall.box
    const box = { ...wall.box, x: x + way[0] * by_m, y: y + way[1] * by_m }
    wall.place(box)
    store.flags(placed(box))
  }
  if (event.key === '+' || event.key === '=') wall.zoom(1.25)
  if (event.key === '-' || event.key === '−') wall.zoom(0.8)
  if (event.key === '0') wall.fit()
}

/** Says whose light it is: that of the head that draws, or would: the one that the studio was opened for, or a simulated one. */
function heads() {
  const { name, at_port, real } = head ?? { name: '', at_port: false, real: false }
  const by_job = run.on && run.began
  const draws = by_job ? run.head !== null : at_port && (run.rest ? run.rest.rig === name : !store.asked.flags.rig)
  const is_real = draws && (by_job ? run.head?.real === true : real)
  const unknown = head === undefined || (run.on && !run.began && at_port)
  by('ribbon').textContent = unknown ? '? Head' : is_real ? `Real: ${name}` : draws ? `Practice: ${name}` : 'Simulated'
  by('ribbon').classList.toggle('real', is_real)
  run.atPort(draws, is_real)
  // without a head at a port there is none to be moved
  if (at_port) pad().then((view) => view.show(draws && operates)).catch(problem)
}

store.watch((asked) => {
  fields.show(asked.flags)
  marks.show(plan?.plan ?? null)
  dark.show(plan?.plan ?? null)
  heads()
  // what was traced was another wish
  by('result').hidden = true
  keep('sessionStorage', 'asked', JSON.stringify(asked))
  wall.place({ ...lies(asked.flags), width: wall.box.width, height: wall.box.height })
  pictures.mark(asked.picture)
  fix(location.hash === '#run')
  by('name').textContent = called(asked.picture)
  planSoon()
})

by('trace').addEventListener('click', trace)
by('stop').addEventListener('click', stop)
by('open-camera').addEventListener('click', () => camera().then((view) => view.open()).catch(problem))
by('copy').addEventListener('click', () => navigator.clipboard?.writeText(by('command').textContent ?? ''))
by('zoom-in').addEventListener('click', () => wall.zoom(1.25))
by('zoom-out').addEventListener('click', () => wall.zoom(0.8))
by('zoom-fit').addEventListener('click', () => wall.fit())
by('undo').addEventListener('click', () => store.undo())
by('redo').addEventListener('click', () => store.redo())
addEventListener('keydown', key)
addEventListener('keyup', () => run.released())
addEventListener('hashchange', () => {
  // an invitation that is opened where the page is already
  if (location.hash.startsWith('#join=')) location.reload()
  else views.show()
})
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => wall.redraw())

themes(by('theme'), () => wall.redraw())
units(by('units'), (imperial) => {
  shown.imperial = imperial
  if (plan) figures(plan)
  wall.redraw()
})
fields.show(store.asked.flags)
by('name').textContent = called(store.asked.picture)
document.body.classList.toggle('looks-on', !operates)
by('fields').toggleAttribute('inert', !operates)
views.show()
if (session?.role === null) {
  document.body.classList.add('outside')
  by('name').textContent = 'Tracelight'
  // nobody tells this device
  lamp('? Unknown')
} else {
  planSoon(0)
  pictures.list().catch(problem)
  about()
  look()
  setInterval(look, LOOK)
}

/** Asks what studio this is, until it is told. */
async function about() {
  try {
    const told = await api.about()
    folder = told.folder
    head = told.head
    if (head) {
      fields.name('rig', `${head.name}: the one here`)
      fields.offer('rig', 'report', 'report: as of 2006')
    }
    await ownRigs()
    heads()
    views.show()
  } catch (error) {
    problem(error)
    setTimeout(about, 2 * LOOK)
  }
}

/** Lets the head be chosen among the folder’s rig files too; what is planned with one that was changed is planned anew. */
async function ownRigs() {
  const [all, known] = await Promise.all([api.rigs(), api.calibrations()])
  ownHeads(known)
  fields.also('rig', all.filter((rig) => rig.own && !rig.problem).map((rig) => [rig.name, rig.name]), store.asked.flags)
  if (all.some((rig) => rig.own && rig.name === store.asked.flags.rig)) planSoon()
}

/** Lets the head stand where it was found. @param {api.Calibration[]} all */
function ownHeads(all) {
  fields.also('head', all.filter((of) => of.kind === 'heads' && !of.problem).map((of) => [of.name, of.name]), store.asked.flags)
}

/** Looks whether somebody traces: another page, or this one before it was loaded again. */
async function look() {
  if (tracing || run.busy()) return
  let job
  try {
    job = await api.job()
  } catch {
    // nobody tells what light there is
    return lamp('? Unknown')
  }
  if (tracing || run.busy()) return
  if (!job || job.over) return by('lamp').textContent?.startsWith('?') ? lamp('● Dark') : undefined
  if (job.live) {
    // what is drawn is on the wall, whoever asked for it, and what was placed here comes back after it
    const before = store.asked
    take_up(job, '#run')
    const during = JSON.stringify(store.asked)
    await run.followed()
    if (JSON.stringify(store.asked) === during) choose(before.picture, before.flags)
    return
  }
  setTracing(true)
  await followed()
  if (plan) problem(null)
}
