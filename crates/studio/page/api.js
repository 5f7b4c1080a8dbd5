// @ts-check
/** What the server is asked. */

/**
 * @typedef {{ code: string, message: string, help?: string, where?: { file: string, line: number, column: number } | null }} Failure what went wrong, as the program says it
 * @typedef {{ id: string, example: boolean, shows: boolean }} Picture
 * @typedef {Record<string, string | boolean | string[]>} Flags flags of the command line, with underscores
 * @typedef {{ number: number, length_m: number, lit_from_s: number, lit_to_s: number }} Stroke
 * @typedef {{ unit: 'px' | 'm', corners: [number, number][], target_m: [number, number][], picture_px: [number, number] | null, unit_guessed: boolean }} Sheet how places of the drawing are named, and where they lie
 * @typedef {{ by: string, residual_mm: number[], rms_mm: number, worst: number }} Align
 * @typedef {{ target: { width_m: number, height_m: number, corners_m: [number, number][] }, strokes: { count: number, length_m: number }, plan: { duration_s: number },
 *   head: { spot_mm: number, best_distance_m: number, distance_m: number }, sequence: Stroke[], sheet: Sheet | null, align: Align | null, no_go: { outlines_m: [number, number][][], length_m?: number } | null }} PlanFigures
 * @typedef {{ id: number, command: string, plan: PlanFigures, remarks: string[], points: string }} Plan
 * @typedef {{ id: number, run: string, picture: string, flags: Flags | null, stage: string, done: number, of: number, remarks: string[], over: boolean, live: boolean, answer: any, failure: Failure | null }} Job
 * @typedef {{ id: string, folder: string, begun: string, picture: string | null, flags: Flags | null, rig: string | null, mode: string, points: { count: number, done: number } | null, files: { name: string, bytes: number }[], width_m: number, height_m: number, strokes: number, duration_s: number | null,
 *   rms_mm: number | null, max_mm: number | null, finished: boolean, running: boolean, left: boolean, went_on_in: string | null, goes_on_with: string | null, progress: { stroke: number, strokes: number } | null }} RunTold
 * @typedef {{ first: RunTold, second: RunTold, same_drawing: boolean, only_first_asked: string[], only_second_asked: string[], figures: { name: string, unit: string, digits: number, first: number | null, second: number | null, difference: number | null }[] }} Compared
 * @typedef {{ command: string, answer: any, words: string, svg: string, rig: string | null, failure: Failure | null }} Experiment
 * @typedef {{ name: string, planned_as: string, at_port: boolean, real: boolean }} Head
 * @typedef {{ name: string, own: boolean, description: string, problem: Failure | null }} Rig
 * @typedef {{ name: string, kind: 'cameras' | 'heads', problem: Failure | null, of?: 'camera' | 'lens' | 'head', date: string, off_mm?: number | null, verdict?: string | null, size_px?: [number, number] | null, pages?: number, rig?: string | null }} Calibration
 * @typedef {{ id: number, name: string, role: 'operator' | 'viewer', lines: number, seen_s: number }} Device
 * @typedef {{ role: 'operator' | 'viewer' | null, local: boolean, device: number, lan: { addresses: string[], fingerprint: string } | null, devices: Device[] | null, last: { picture: string, flags: Flags } | null }} Session
 * @typedef {{ role: string, links: string[], code_svg: string | null, fingerprint: string, holds_s: number }} Invitation
 */

/** A refusal, with what the program says about it. */
export class Refusal extends Error {
  /** @param {Failure} failure @param {number} status */
  constructor(failure, status) {
    super(failure.message)
    this.failure = failure
    this.status = status
  }
}

/** @param {Response} response */
async function checked(response) {
  if (response.ok) return response
  const told = await response.json().catch(() => null)
  const failure = told?.error ?? { code: 'internal', message: `the server answers ${response.status}` }
  throw new Refusal(failure, response.status)
}

/** @param {string} path @param {RequestInit} [init] @returns {Promise<any>} */
export async function json(path, init) {
  const response = await fetch(`/api/v1${path}`, init).catch(() => {
    throw new Refusal({ code: 'gone', message: 'The studio’s server does not answer: is it still running in its terminal?' }, 0)
  })
  return (await checked(response)).json()
}

/** @param {string} path @param {unknown} body @param {AbortSignal} [signal] */
export const post = (path, body, signal) => json(path, { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body), signal })

/** @returns {Promise<{ version: string, folder: string, head: Head | null }>} */
export const about = () => json('/about')
/** @returns {Promise<Picture[]>} */
export const pictures = async () => (await json('/pictures')).pictures
/** @param {File} file @returns {Promise<string>} */
export const add = async (file) => (await json(`/pictures?name=${encodeURIComponent(file.name || 'pasted.png')}`, { method: 'POST', body: file })).id
/** @param {string} id */
export const pictureUrl = (id) => `/api/v1/pictures/${encodeURIComponent(id)}`
/** @param {{ page: string, number: number, picture: string, flags: Flags }} asked @param {AbortSignal} signal @returns {Promise<Plan>} */
export const plan = (asked, signal) => post('/plans', asked, signal)
/** @param {{ picture: string, flags: Flags }} asked @returns {Promise<Job>} */
export const trace = (asked) => post('/jobs', asked)
/** Begins a job that a page operates: dark, until somebody arms it. @param {{ page: string, picture?: string, rest_of?: string, flags: Flags }} asked @returns {Promise<Job>} */
export const attend = (asked) => post('/jobs', { ...asked, attended: true })
/** @returns {Promise<Job | null>} */
export const job = async () => (await json('/jobs/current')).job
/** Moves the head at the port by hand, dark. @param {{ move: string, by?: string }} asked @returns {Promise<{ homed: boolean, pan_deg: number, tilt_deg: number }>} */
export const moveHead = (asked) => post('/head', asked)
/** An experiment of the lab. @param {{ command: string, of: string[], flags: Flags }} asked @param {AbortSignal} [signal] @returns {Promise<Experiment>} */
export const experiment = (asked, signal) => post('/lab', asked, signal)
/** Numbers of the lessons that were passed. @returns {Promise<number[]>} */
export const lessons = async () => (await json('/lab/lessons')).passed
export const stop = () => post('/stop', {})
/** @returns {Promise<RunTold[]>} */
export const runs = async () => (await json('/runs')).runs
/** @param {string} first @param {string} second @returns {Promise<Compared>} */
export const compare = (first, second) => json(`/compare?first=${encodeURIComponent(first)}&second=${encodeURIComponent(second)}`)
/** @returns {Promise<Calibration[]>} */
export const calibrations = async () => (await json('/calibrations')).calibrations
/** @returns {Promise<Rig[]>} */
export const rigs = async () => (await json('/rigs')).rigs
/** What a rig file says. @param {string} name @returns {Promise<{ name: string, own: boolean, toml: string }>} */
export const rig = (name) => json(`/rigs/${encodeURIComponent(name)}`)
/** Keeps a rig file in place of what it said before, or only looks whether it is one. @param {string} name @param {string} toml @param {{ before?: string, only_check?: boolean }} how @returns {Promise<{ remarks: string[] }>} */
export const writeRig = (name, toml, how) => json(`/rigs/${encodeURIComponent(name)}`, { method: 'PUT', headers: { 'content-type': 'application/json' }, body: JSON.stringify({ toml, ...how }) })
/** Puts something into the trash; its name there. @param {'runs' | 'pictures' | 'rigs'} kind @param {string} id @returns {Promise<string>} */
export const discard = async (kind, id) => (await json(`/${kind}/${encodeURIComponent(id)}`, { method: 'DELETE' })).in_trash
/** @param {'runs' | 'pictures' | 'rigs' | 'cameras' | 'heads'} kind @param {string} name */
export const restore = (kind, name) => post(`/trash/${kind}/${encodeURIComponent(name)}`, {})
/** @returns {Promise<Session>} */
export const session = () => json('/session')
/** @param {string} invitation @param {string} name */
export const join = (invitation, name) => post('/session/join', { invitation, name })
/** @param {'operator' | 'viewer'} role @returns {Promise<Invitation>} */
export const invite = (role) => post('/session/invitations', { role })
/** @param {number} id */
export const sendAway = (id) => json(`/session/devices/${id}`, { method: 'DELETE' })
/** @param {string} run @param {string} name */
export const runFile = (run, name) => `/api/v1/runs/${encodeURIComponent(run)}/files/${name}`

/**
 * A plan's points, a value a tick in each column.
 * @typedef {{ x: Float32Array, y: Float32Array, lit: Float32Array, stroke: Float32Array, speed: Float32Array, rows: number, ticksARow: number }} Points
 * @param {string} path @returns {Promise<Points>}
 */
export async function points(path) {
  const buffer = await (await checked(await fetch(path))).arrayBuffer()
  const head = new DataView(buffer)
  const [columns, rows, ticksARow] = [head.getUint16(2, true), head.getUint32(8, true), head.getUint32(12, true)]
  const column = (/** @type {number} */ n) => new Float32Array(buffer, 16 + 4 * n * rows, rows)
  if (head.getUint8(0) !== 5 || columns < 5) throw new Refusal({ code: 'internal', message: 'the plan’s points are of a kind that this page does not know' }, 0)
  return { x: column(0), y: column(1), lit: column(2), stroke: column(3), speed: column(4), rows, ticksARow }
}
