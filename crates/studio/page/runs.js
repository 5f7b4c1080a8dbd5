// @ts-check
/** Runs: the one that goes on, and those that were. */

import { job, runFile, runs } from './api.js'
import { length, plain, time } from './words.js'

/** How often is asked how far a job is, ms. */
const EVERY = 120

/** Elements of text, classes and children. @param {string} name @param {{ text?: string, class?: string, [attribute: string]: string | undefined }} [how] @param {(Node | string)[]} children */
export function element(name, how = {}, ...children) {
  const made = document.createElement(name)
  for (const [key, value] of Object.entries(how)) {
    if (key === 'text') made.textContent = value ?? ''
    else if (value !== undefined) made.setAttribute(key, value)
  }
  made.append(...children)
  return made
}

/** Waits until the job is over, and tells how far it is. @param {(job: import('./api.js').Job) => void} told @returns {Promise<import('./api.js').Job | null>} */
export async function follow(told) {
  for (let missed = 0; ; ) {
    try {
      const now = await job()
      if (!now) return null
      told(now)
      if (now.over) return now
      missed = 0
    } catch (error) {
      // a server that is busy for a moment is asked again
      if (++missed > 20) throw error
    }
    await new Promise((later) => setTimeout(later, EVERY))
  }
}

/** How a job ended, as a card. @param {HTMLElement} card @param {import('./api.js').Job} ended */
export function showResult(card, ended) {
  card.hidden = false
  card.replaceChildren()
  const { answer, failure, run, picture } = ended
  card.classList.toggle('failed', failure !== null)
  if (failure) {
    const stopped = failure.code === 'interrupted'
    card.append(element('h2', { text: stopped ? 'Stopped' : 'It did not end well' }), element('p', { text: stopped ? 'The head is dark. Runs has what was drawn until then.' : failure.message }))
    if (!stopped && failure.help && failure.code !== 'usage') card.append(element('p', { class: 'under', text: failure.help }))
  }
  // of a part of it no error tells how exact the whole would be
  if (failure || !answer?.tracking) return
  const { tracking, plan, target } = answer
  card.append(element('h2', { text: `${picture}: traced on the simulated head` }))
  card.append(
    element('img', { src: runFile(run, 'trace.png'), alt: 'What a camera with an open shutter would have seen of the wall', width: '320' }),
    element('p', {}, element('strong', { text: `${plain(tracking.max_mm, 2)} mm` }), ' off at most, ', element('strong', { text: `${plain(tracking.rms_mm, 3)} mm` }), ' rms'),
    element('p', { class: 'under', text: `${length(target.width_m)} × ${length(target.height_m)} in ${time(plan.duration_s)}` }),
    element('a', { href: runFile(run, 'report.html'), target: '_blank', rel: 'noopener', class: 'plain', text: 'Open the report' }),
  )
}

/** All runs. @param {HTMLElement} list @param {HTMLElement} where @param {string} folder */
export async function showRuns(list, where, folder) {
  const all = await runs()
  where.textContent = all.length === 0 ? 'There are none yet: trace a picture.' : `They lie in ${folder}.`
  list.replaceChildren(...all.reverse().map(card))
}

/** @param {any} run */
function card(run) {
  const id = run.folder.split(/[\\/]/).pop()
  const off = !run.finished || run.max_mm === null || run.max_mm === undefined ? '' : `${plain(run.max_mm, 2)} mm off at most`
  const { stroke, strokes } = run.progress ?? { stroke: 0, strokes: run.strokes }
  const came = run.finished ? '' : `not finished: stroke ${stroke} of ${strokes}`
  const size = run.width_m ? `${length(run.width_m)} × ${length(run.height_m)}, ${run.strokes} strokes, ${time(run.duration_s ?? 0)}` : ''
  return element(
    'li',
    {},
    element('img', { src: runFile(id, 'trace.png'), alt: '', loading: 'lazy' }),
    element('div', {}, element('h3', { text: id }), element('p', { class: 'under', text: run.begun ?? '' }), element('p', { text: size }), element('p', { text: came + off }), element('a', { href: runFile(id, 'report.html'), target: '_blank', rel: 'noopener', text: 'Report' })),
  )
}
