// @ts-check
/** What is asked about cameras and calibrations. */

import { json, post } from './api.js'

/**
 * @typedef {import('./api.js').Calibration} Calibration
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {{ id: string, name: string, simulated: boolean }} Camera
 * @typedef {{ number: number, image: string, width_px: number, height_px: number, exposed: 'dark' | 'well' | 'bright', markers: { id: number, page: number | null, corners_px: [number, number][] }[], pages: { page: number, board: string, markers: number, of: number }[], calibration: { rms_px: number | null, holds: boolean } | null, remarks: string[] }} Sight
 * @typedef {{ command: string, answer: any, words: string, remarks: string[], calibration: Calibration, replaced: string | null }} Calibrated
 */

/** @returns {Promise<Camera[]>} */
export const cameras = async () => (await json('/cameras')).cameras
/** What a camera sees in an image newer than that, held against a calibration. @param {string} id @param {string} calibration @param {number} after @returns {Promise<Sight>} */
export const look = (id, calibration, after) => json(`/cameras/${encodeURIComponent(id)}/look?after=${after}&calibration=${encodeURIComponent(calibration)}`)
/** @param {{ of: 'markers' | 'lens' | 'head' | 'corners', name: string, camera?: string, pictures?: string[], flags: Flags }} asked @returns {Promise<Calibrated>} */
export const calibrate = (asked) => post('/calibrations', asked)
/** @param {'cameras' | 'heads'} kind @param {string} name @returns {Promise<string>} */
export const discardCalibration = async (kind, name) => (await json(`/calibrations/${kind}/${encodeURIComponent(name)}`, { method: 'DELETE' })).in_trash
/** Pages of markers, to be printed. @param {string} paper @param {string} board */
export const printed = (paper, board) => `/api/v1/calibrations/pages.pdf?paper=${paper}&board=${board}`
