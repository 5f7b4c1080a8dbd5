// @ts-check
/** The job in hand: how far it is, and how it ended. */

import { Refusal, job, runFile } from './api.js'
import { element } from './dom.js'
import { called, length, plain, time } from './words.js'

/** How often is asked how far a job is, ms. */
const EVERY = 120

/** Who tells where the light was, where no simulation does. @type {Record<string, string>} */
const SEEN_BY = { encoders: 'As its encoders say: nobody saw the light.', commands: 'As it was commanded: nobody measured the head.' }

/** Waits until the job is over, and tells how far it is; for as long as it takes where somebody attends it, whatever becomes of the line. @param {(job: import('./api.js').Job) => void} told @param {boolean} [patiently] @returns {Promise<import('./api.js').Job | null>} */
export async function follow(told, patiently = false) {
  for (let missed = 0; ; ) {
    try {
      const now = await job()
      if (!now) return null
      told(now)
      if (now.over) return now
      missed = 0
    } catch (error) {
      // a server that is busy for a moment is asked again
      const is_refused = error instanceof Refusal && error.status > 0
      if (is_refused || (++missed > 20 && !patiently)) throw error
    }
    await new Promise((later) => setTimeout(later, missed > 20 ? 8 * EVERY : EVERY))
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
  card.append(element('h2', { text: `${called(picture)}: ${answer.simulated ? 'traced on the simulated head' : 'drawn'}` }))
  const found = [...(answer.laser?.faults ?? []).filter((/** @type {{ stops: boolean }} */ fault) => fault.stops).map((/** @type {{ code: string, t_s: number }} */ fault) => `after ${plain(fault.t_s, 1)} s: fault ${fault.code}`), ...(answer.camera?.follow?.recoveries ?? []).map((/** @type {{ t_s: number, what: string }} */ of) => `after ${plain(of.t_s, 1)} s ${of.what}`), ...(answer.camera?.follow?.remarks ?? [])]
  card.classList.toggle('failed', found.length > 0)
  // a remark may say the same
  if (found.length > 0) card.append(element('ul', { class: 'remarks' }, ...[...new Set(found)].map((text) => element('li', { text }))))
  card.append(
    element('img', { src: runFile(run, 'trace.png'), alt: 'What a camera with an open shutter would have seen of the wall', width: '320' }),
    element('p', {}, element('strong', { text: `${plain(tracking.max_mm, 2)} mm` }), ' off at most, ', element('strong', { text: `${plain(tracking.rms_mm, 3)} mm` }), ' rms'),
    ...(SEEN_BY[answer.light_from] ? [element('p', { class: 'under', text: SEEN_BY[answer.light_from] })] : []),
    element('p', { class: 'under', text: `${length(target.width_m)} × ${length(target.height_m)} in ${time(plan.duration_s)}` }),
    element('a', { href: runFile(run, 'report.html'), target: '_blank', rel: 'noopener', class: 'plain', text: 'Open the report' }),
  )
}
