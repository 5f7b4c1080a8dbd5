// A browser uses the studio: node studio.mjs ADDRESS PICTURE [ADDRESS], of one that was just opened on an empty folder, and of one for a board that was just powered up.
// The first minute by one click, marks and areas on the wall, a camera and its calibration, dragging, typing, undoing, a wrong value, what is no picture, a picture from a file, stopping from within a field; at three widths, on each ground, nothing
// axe finds wrong, nothing wider than the screen, no error of a script, nothing asked of anybody else; somebody attends a job, is lost, goes on with an old one, and joins from a phone.
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { chromium } from 'playwright-core'

const address = process.argv[2], picture = process.argv[3]
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8')
const complaints = []
const check = (holds, what) => holds || complaints.push(what)

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] })

const opened = async (width, height, options = {}) => {
  const context = await browser.newContext({ viewport: { width, height }, bypassCSP: true, ...options })
  const page = await context.newPage()
  page.on('pageerror', error => complaints.push(`${width} px: ${error.message}`))
  page.on('request', request => /^(data|blob):/.test(request.url()) || request.url().startsWith(address) || complaints.push(`asks for ${request.url()}`))
  // a page that comes new begins with what was placed last
  await page.goto(address + '#picture=house.png')
  await page.waitForFunction(() => document.getElementById('count').textContent !== '–')
  return page
}
const value = (page, name) => page.inputValue(`[name=${name}]`)
// what is not there yet does not hold yet
const until = async (page, what, holds) => page.waitForFunction(text => {
  try {
    return new Function(`return ${text}`)()
  } catch {
    return false
  }
}, typeof holds === 'string' ? holds : `(${holds})()`, { timeout: 10000 }).catch(() => complaints.push(what))

const firstMinute = async () => {
  const page = await opened(1280, 800), began = Date.now()
  await page.click('#trace')
  await page.waitForSelector('#result:not([hidden])')
  const took = (Date.now() - began) / 1000
  check(took <= 10, `the house took ${took} s`)
  check(/mm off at most/.test(await page.textContent('#result')), 'the result tells no error')
  const report = await page.request.get(new URL(await page.getAttribute('#result a', 'href'), address).href)
  check(report.ok() && /sandbox/.test(report.headers()['content-security-policy']), 'no report, or one that may do anything')
  await page.click('#to-runs')
  await until(page, 'the run is not listed', () => document.querySelectorAll('#run-list > li').length === 1)
  await page.close()
  return took
}

const place = async () => {
  const page = await opened(1280, 800)
  const box = await page.locator('#wall').boundingBox()
  const [x, y] = [box.x + box.width / 2 + 13, box.y + box.height / 2 + 13]
  await page.mouse.move(x, y)
  await page.mouse.down()
  await page.mouse.move(x + 80, y - 40, { steps: 8 })
  check(/mm,/.test(await value(page, 'offset')), 'what is dragged is not told while it is')
  await page.mouse.up()
  await until(page, 'what was dragged is not planned', () => /--offset=/.test(document.getElementById('command').textContent))
  await page.fill('[name=rotate]', '20deg')
  await page.press('[name=rotate]', 'Enter')
  await until(page, 'what was turned is not planned', () => /--rotate=20deg/.test(document.getElementById('command').textContent))
  await page.fill('[name=width]', '3x')
  await page.press('[name=width]', 'Tab')
  await until(page, 'a wrong width is not told', () => /use one of m, mm, cm/.test(document.getElementById('problem').textContent))
  check((await page.getAttribute('[name=width]', 'aria-invalid')) === 'true', 'the field with the wrong value is not marked')
  await page.focus('#wall')
  for (let n = 0; n < 3; n++) await page.keyboard.press('Control+z')
  check((await value(page, 'offset')) === '' && (await value(page, 'width')) === '', 'it cannot be undone')
  await until(page, 'the wrong value is still told', () => document.getElementById('problem').hidden)
  await page.keyboard.press('Shift+ArrowRight')
  check((await value(page, 'offset')) === '10mm,0mm', 'arrows do not move it')
  // what only the program can read lies where the program has planned it
  await page.fill('[name=offset]', `1'2",3"`)
  await page.press('[name=offset]', 'Enter')
  await until(page, 'feet and inches are not planned', () => /--offset=1'/.test(document.getElementById('command').textContent) && !document.body.classList.contains('waits'))
  await page.focus('#wall')
  await page.keyboard.press('ArrowRight')
  check((await value(page, 'offset')) === '356.6mm,76.2mm', `an arrow takes it elsewhere: ${await value(page, 'offset')}`)
  await page.setInputFiles('#file', { name: 'none.png', mimeType: 'image/png', buffer: Buffer.from('no picture') })
  await until(page, 'what is no picture is not refused', () => /none of PNG/.test(document.getElementById('problem').textContent))
  check((await page.getAttribute('#trace', 'disabled')) !== null && (await page.textContent('#count')) === '–', 'what was shown before is shown as what was chosen')
  await page.setInputFiles('#file', picture)
  await until(page, 'a picture from a file is not planned', () => /sheet/.test(document.getElementById('command').textContent))
  // stopping asks for no focus and no second key
  await page.focus('[name=width]')
  const stopped = page.waitForRequest(request => request.url().endsWith('/api/v1/stop'))
  await page.keyboard.press('Escape')
  await Promise.race([stopped, new Promise((_, late) => setTimeout(late, 500))]).catch(() => complaints.push('Esc in a field does not stop'))
  await page.close()
}

// By marks, areas that are never lit, corners of a sheet, a unit that nobody told, in inches.
const onWall = async () => {
  const page = await opened(1280, 800)
  const box = await page.locator('#wall').boundingBox()
  const at = (x, y) => [box.x + box.width * x, box.y + box.height * y]
  const planned = async act => {
    const [answer] = await Promise.all([page.waitForResponse(response => /plans$/.test(response.url()) && response.ok()), act()])
    const { plan } = await answer.json()
    await page.waitForFunction(() => !document.body.classList.contains('waits'))
    return plan
  }
  await page.click('#marks summary')
  const mark = async (x, y) => {
    await page.click('#add-mark')
    return planned(() => page.mouse.click(...at(x, y)))
  }
  const type = (n, text) => planned(async () => {
    await page.locator('#mark-list input').nth(n).fill(text)
    await page.keyboard.press('Enter')
  })
  const { target: first } = await mark(0.3, 0.7)
  const lay = (await page.locator('#mark-list input').first().inputValue()).split(',').map(parseFloat)
  const { target: moved } = await type(0, '0m,0m')
  const off = moved.corners_m[0].map((m, n) => 1000 * (m - first.corners_m[0][n]) + lay[n])
  check(Math.hypot(...off) < 0.2, `a mark puts it ${off} mm elsewhere`)
  await mark(0.7, 0.7)
  const far = (await page.locator('#mark-list input').nth(1).inputValue()).split(',').map(parseFloat)
  const { target: larger, align } = await type(1, `${2 * far[0]}mm,${2 * far[1]}mm`)
  check(align.by === 'similarity' && Math.abs(larger.width_m / first.width_m - 2) < 2e-3, `two marks make it ${larger.width_m} m wide`)
  await page.click('#dark summary')
  await page.click('#add-dark')
  await page.keyboard.press('Escape')
  check(await page.locator('#pointing').isHidden(), 'Esc does not end what is shown')
  await page.click('#add-dark')
  const { no_go } = await planned(async () => {
    await page.mouse.move(...at(0.45, 0.4))
    await page.mouse.down()
    await page.mouse.move(...at(0.6, 0.6), { steps: 4 })
    await page.mouse.up()
  })
  check(no_go.outlines_m[0].length === 5 && no_go.length_m > 0, 'an area that was drawn is not kept dark')
  await page.click('#units')
  check(/ in/.test(await page.textContent('#size')) && / ft/.test(await page.textContent('#length')), 'no inches')
  await page.click('#units')
  await page.goto(address + '#picture=star.png')
  await page.reload()
  await page.waitForFunction(() => document.getElementById('count').textContent !== '–')
  await page.getByText('Sheet of paper').click()
  await page.click('#show-corners')
  for (const corner of [[0.4, 0.2], [0.7, 0.25], [0.7, 0.8]]) await page.mouse.click(...at(...corner))
  await planned(() => page.mouse.click(...at(0.35, 0.75)))
  check((await page.locator('[name=straighten]').inputValue()).split(' ').length === 4, 'four corners are not told')
  const line = '0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n60\n21\n40\n0\nENDSEC\n0\nEOF\n'
  await page.setInputFiles('#file', { name: 'line.dxf', mimeType: 'image/vnd.dxf', buffer: Buffer.from(line) })
  await until(page, 'nobody asks for a unit', () => /names no unit/.test(document.getElementById('unit').textContent))
  const { target: inches } = await planned(() => page.click('#unit button:has-text("in")'))
  check(Math.abs(inches.width_m - 60 * 0.0254) < 1e-6 && (await page.locator('#unit').isHidden()), `in inches it is ${inches.width_m} m wide`)
  await page.context().close()
}

const state = page => page.textContent('#state')
const lamp = page => page.textContent('#lamp')
const hold = async (page, time) => {
  await page.locator('#arm').evaluate(arm => arm.scrollIntoView({ block: 'center' }))
  const box = await page.locator('#arm').boundingBox()
  await page.mouse.move(box.x + 20, box.y + 20)
  await page.mouse.down()
  await page.waitForTimeout(time)
  await page.mouse.up()
  await page.waitForTimeout(150)
}
const getReady = async page => {
  await page.click('#begin')
  await until(page, 'it does not get ready', () => /Ready/.test(document.getElementById('state').textContent))
}
const ready = async page => {
  await page.goto(address + '#run')
  await getReady(page)
}
const goes = async page => {
  await getReady(page)
  await hold(page, 1100)
  await page.click('#go')
}
const lit = page => page.evaluate(() => document.body.classList.contains('lit'))
const untilLit = (page, when) => until(page, `it is not lit ${when}`, () => document.body.classList.contains('lit'))
const ended = async page => {
  await page.click('#end')
  await until(page, 'it does not end', () => !document.getElementById('before').hidden)
}

// Somebody attends a job: arms by holding, traces, pauses, stops from a field, ends; nothing else lights it.
const attend = async () => {
  const page = await opened(1280, 900)
  // a program that speaks Foxglove's protocol reads what happens
  await page.evaluate(() => {
    const told = (globalThis.foxglove = { lines: 0 })
    const socket = new WebSocket(`ws://${location.host}/api/v1/foxglove`, ['foxglove.sdk.v1', 'foxglove.websocket.v1'])
    socket.binaryType = 'arraybuffer'
    const topics = new Map()
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string') {
        for (const { id, topic } of JSON.parse(data).channels ?? []) topics.set(topics.size, topic), socket.send(JSON.stringify({ op: 'subscribe', subscriptions: [{ id: topics.size - 1, channelId: id }] }))
        return
      }
      const topic = topics.get(new DataView(data).getUint32(1, true)), what = JSON.parse(new TextDecoder().decode(data.slice(13)))
      told[topic] = (told[topic] ?? 0) + 1
      if (topic === '/plan') told.lines = what.entities[0].lines.length
    }
  })
  await ready(page)
  check(/✓|⚠/.test(await page.textContent('#checks')), 'nothing was looked at before light')
  await hold(page, 700)
  check(/Ready/.test(await state(page)), 'it is armed by less than a second')
  await hold(page, 1100)
  check(/Armed/.test(await lamp(page)), 'holding does not arm')
  await until(page, 'arming does not run out', () => /Ready/.test(document.getElementById('state').textContent))
  await page.keyboard.down('a')
  await page.waitForTimeout(1100)
  await page.keyboard.up('a')
  await page.waitForTimeout(150)
  check(/Armed/.test(await lamp(page)), 'holding the key A does not arm')
  await page.keyboard.press(' ')
  await page.waitForTimeout(200)
  check(!(await lit(page)), 'Space begins light')
  await page.click('#go')
  await untilLit(page, 'once it is armed')
  await page.click('#pause-now')
  await until(page, 'it does not pause', () => /Paused/.test(document.getElementById('state').textContent) && !document.body.classList.contains('lit'))
  await page.keyboard.press(' ')
  await untilLit(page, 'after a pause')
  // somebody else looks on, and may stop it
  const other = await opened(820, 1100)
  await until(other, 'another page does not show the run', () => location.hash === '#run' && !document.getElementById('viewer').hidden)
  check(await other.isDisabled('#arm') && await other.isDisabled('#pause'), 'who looks on may operate it')
  const began = Date.now()
  await other.click('#stop')
  await until(page, 'another page does not stop it', () => /Stopped/.test(document.getElementById('state').textContent))
  const took = Date.now() - began
  const read = await page.evaluate(() => globalThis.foxglove)
  check(read.lines === 28 && read['/progress'] > 20 && read['/asked'] > 20 && read['/log'] > 3, `Foxglove is told ${JSON.stringify(read)}`)
  check(!(await lit(page)), 'what is stopped is lit')
  await hold(page, 1100)
  await page.click('#go')
  await untilLit(page, 'after it was stopped')
  await page.focus('#faster')
  await page.keyboard.press('Escape')
  await until(page, 'Esc does not stop it', () => /Stopped/.test(document.getElementById('state').textContent))
  // who takes it over gets it dark
  await other.click('#take')
  await until(page, 'the operator is not asked', () => !document.getElementById('asks').hidden)
  await page.click('#refuse')
  await until(other, 'who is refused is not told', () => /keeps it/.test(document.getElementById('said').textContent))
  await ended(page)
  await until(page, 'it is not told how it ended', () => /Stopped/.test(document.getElementById('attended').textContent))
  await other.context().close()
  await page.context().close()
  return took
}

// Whoever operates it is lost: dark within two seconds, and another page may have it.
const lost = async () => {
  const page = await opened(1280, 900)
  await ready(page)
  await hold(page, 1100)
  await page.click('#go')
  await untilLit(page, 'for who is lost')
  const other = await opened(390, 844)
  await until(other, 'another page does not show the run', () => location.hash === '#run' && document.body.classList.contains('lit'))
  const began = Date.now()
  await page.context().close()
  await until(other, 'a lost operator leaves it lit', () => /Stopped, dark/.test(document.getElementById('state').textContent))
  const took = Date.now() - began
  check(took <= 2300, `a lost operator leaves it lit for ${took} ms`)
  await other.click('#take')
  await until(other, 'nobody may take over', () => document.getElementById('viewer').hidden)
  await ended(other)
  await other.context().close()
  return took
}

// Stroke by stroke, and point by point; a frame first.
const steps = async () => {
  const page = await opened(390, 844)
  await page.goto(address + '#run')
  await page.click('text=Step')
  await page.selectOption('#times', '2')
  await goes(page)
  for (const number of [1, 2, 3]) {
    await until(page, `stroke ${number} is not drawn`, `/again and again/.test(document.getElementById('state').textContent) && /stroke ${number} of/.test(document.getElementById('where').textContent)`)
    await page.click('#next')
  }
  await ended(page)
  await page.click('text=Points')
  await goes(page)
  await until(page, 'no point is marked', () => / 1 of /.test(document.getElementById('where').textContent))
  await page.click('#next')
  await until(page, 'the next point is not marked', () => / 2 of /.test(document.getElementById('where').textContent))
  await ended(page)
  await page.click('text=Trace')
  await page.selectOption('#frame', 'box')
  await goes(page)
  await until(page, 'the frame is not shown', () => /frame/.test(document.getElementById('state').textContent) && document.body.classList.contains('lit'))
  await page.click('#go')
  await until(page, 'the drawing does not follow its frame', () => /stroke 1 of/.test(document.getElementById('where').textContent))
  await ended(page)
  await page.context().close()
}

// Whatever keys are pressed, one or two at once, on whatever view: no light.
const keys = async () => {
  const page = await opened(1280, 900)
  const all = ['Enter', ' ', 'a', 'f', 't', 'r', 'n', 'p', '.', ',', '+', 'PageDown', 'ArrowRight', 'Tab']
  for (const view of ['', '#run', '#runs', '#lab', '#devices']) {
    await page.goto(address + view)
    if (view === '#run') await ready(page)
    await page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement)?.blur())
    for (const one of all) {
      for (const other of all) {
        await page.keyboard.down(one)
        if (other !== one) await page.keyboard.press(other)
        await page.keyboard.up(one)
        if (await lit(page)) complaints.push(`${one} and ${other} on ${view || 'place'} light it`)
      }
      await page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement)?.blur())
    }
  }
  await page.goto(address + '#run')
  await ended(page)
  await page.context().close()
}

// Runs that were: compared, deleted and had back, gone on with at the place where they ended.
const history = async () => {
  const page = await opened(1280, 900)
  const cards = page.locator('#run-list > li')
  await page.goto(address + '#runs')
  await until(page, 'no runs are listed', () => document.querySelectorAll('#run-list > li').length > 2)
  const count = await cards.count()
  await cards.nth(0).getByText('Delete').click()
  await until(page, 'a run is not deleted', `document.querySelectorAll('#run-list > li').length === ${count - 1}`)
  await page.click('#undelete')
  await until(page, 'a deleted run is not had back', `document.querySelectorAll('#run-list > li').length === ${count}`)
  await page.click('[data-run=house]')
  await page.click('[data-run=house-2]')
  await page.click('#to-compare')
  await until(page, 'two runs are not compared', () => document.querySelectorAll('#compare-figures tbody tr').length > 8)
  await page.click('#pair-in')
  const moved = await page.$$eval('.pane img', images => images.map(image => image.style.transform))
  check(moved.length === 2 && moved[0] === moved[1] && /scale\(1\.5\)/.test(moved[0]), `walls do not zoom together: ${moved}`)
  await page.goto(address + '#runs')
  await page.locator('.acts', { hasText: 'From stroke' }).getByText('Go on', { exact: true }).first().click()
  await until(page, 'what is gone on with is not told', () => /The rest of /.test(document.getElementById('rest-words').textContent))
  await goes(page)
  await untilLit(page, 'when a run is gone on with')
  const [left, whole] = await page.evaluate(() => [/of ([\d.]+) s$/, /\/ 0:(\d+)/].map((number, n) => Number(number.exec(document.getElementById(['where', 'clock'][n]).textContent)?.[1])))
  check(left < whole - 0.5, `the rest of a run is ${left} s of ${whole}`)
  await ended(page)
  await page.context().close()
}

// A phone joins by what its camera reads, once, and operates; another device looks on, and stops.
const devices = async () => {
  const page = await opened(1280, 900)
  await page.goto(address + '#devices')
  const invite = async role => {
    await page.click(`#invite-${role}`)
    await until(page, 'no device is invited', () => !document.getElementById('invitation').hidden)
    await page.waitForTimeout(200)
    return page.textContent('#link')
  }
  const join = async (link, width, height) => {
    const context = await browser.newContext({ viewport: { width, height }, ignoreHTTPSErrors: true, bypassCSP: true })
    const device = await context.newPage()
    device.on('pageerror', error => complaints.push(`a device: ${error.message}`))
    await device.goto(link)
    return device
  }
  // what was placed here is what the phone has at the wall
  await page.goto(address)
  await page.fill('[name=width]', '77cm')
  await page.press('[name=width]', 'Enter')
  await until(page, 'a width is not planned', () => /--width=77cm/.test(document.getElementById('command').textContent))
  await page.goto(address + '#devices')
  const link = await invite('operator'), lan = link.split('#')[0]
  const phone = await join(link, 390, 844)
  await until(phone, 'a phone that joined shows no drawing', () => document.getElementById('count').textContent !== '–')
  check(!/join/.test(phone.url()), 'the invitation stays in the address')
  check((await value(phone, 'width')) === '77cm', 'a phone does not show what was placed')
  const thief = await join(link, 390, 844)
  await until(thief, 'an invitation is taken twice', () => !document.getElementById('outside').hidden && /used already/.test(document.getElementById('outside-why').textContent))
  await page.click('#to-place')
  await page.click('#to-devices')
  await until(page, 'who joined is not listed', () => document.querySelectorAll('#device-list li').length === 1)
  const viewer = await join(await invite('viewer'), 820, 1100)
  await until(viewer, 'who looks on sees no drawing', () => document.getElementById('count').textContent !== '–')
  await phone.goto(lan + '#run')
  await goes(phone)
  await untilLit(phone, 'from a phone')
  await until(viewer, 'who looks on does not see the light', () => location.hash === '#run' && document.body.classList.contains('lit'))
  check(await viewer.isDisabled('#arm') && await viewer.isHidden('#take'), 'who looks on may do more')
  const began = Date.now()
  await thief.click('#stop')
  await until(phone, 'a device that has not joined does not stop it', () => /Stopped/.test(document.getElementById('state').textContent))
  await until(phone, 'it is not told that somebody else stopped it', () => /Somebody else/.test(document.getElementById('said').textContent))
  const took = Date.now() - began
  // sent away, it is missed, and nobody
  await hold(phone, 1100)
  await phone.click('#go')
  await untilLit(phone, 'after it was stopped from elsewhere')
  await page.goto(address + '#devices')
  await page.locator('#device-list button').first().click()
  await page.goto(address + '#run')
  await until(page, 'a phone that was sent away leaves it lit', () => /Stopped, dark/.test(document.getElementById('state').textContent))
  await page.click('#take')
  await until(page, 'nobody may take over from a phone that was sent away', () => document.getElementById('viewer').hidden)
  await ended(page)
  for (const one of [page, phone, thief, viewer]) await one.context().close()
  return took
}

// A board at a port that was just powered up: turned by hand, told where it points, drawn with, stopped, gone on with.
const port = async at => {
  const page = await (await browser.newContext({ viewport: { width: 390, height: 844 }, bypassCSP: true })).newPage()
  page.on('pageerror', error => complaints.push(`at the port: ${error.message}`))
  await page.goto(at + '#run')
  await until(page, 'the head is not called real', () => /^Real: /.test(document.getElementById('ribbon').textContent))
  await until(page, 'nothing is planned for the head', () => document.getElementById('count').textContent !== '–')
  await page.click('#begin')
  await until(page, 'a head that does not know where it points is drawn with', () => /home it first/.test(document.getElementById('attended').textContent))
  await page.click('#head summary')
  await until(page, 'it is not told that the head does not know where it points', () => /does not know/.test(document.getElementById('head-at').textContent))
  await page.click('[aria-label=Left]')
  await until(page, 'the head is not turned', () => /pan (1|0\.99|1\.01)°/.test(document.getElementById('head-at').textContent))
  await page.click('[aria-label=Right]')
  await until(page, 'the head is not turned back', () => /pan -?0(\.0\d)?°/.test(document.getElementById('head-at').textContent))
  await page.click('#home')
  await until(page, 'the head is not homed', () => /knows where it points/.test(document.getElementById('head-at').textContent))
  await page.evaluate(axe)
  for (const v of (await page.evaluate(() => globalThis.axe.run())).violations) complaints.push(`at the port: ${v.id}: ${v.nodes[0].html.slice(0, 120)}`)
  await goes(page)
  await untilLit(page, 'at the port')
  await page.click('#stop')
  await until(page, 'a board is not stopped', () => /Stopped, dark/.test(document.getElementById('state').textContent))
  await hold(page, 1100)
  await page.click('#go')
  await untilLit(page, 'at the port, after it was stopped')
  await ended(page)
  await page.context().close()
}

// Experiments whose gains are dragged, a formula that is none, a lesson that is answered wrong, then right.
const lab = async () => {
  const page = await opened(1280, 900)
  await page.goto(address + '#lab')
  await until(page, 'no step is plotted', () => document.querySelector('#lab-plot img')?.complete && /overshoot/.test(document.getElementById('lab-words').textContent))
  const before = await page.textContent('#lab-words')
  await page.locator('[name=kp]').fill('60')
  await until(page, 'a gain that is dragged changes nothing', `document.getElementById('lab-words').textContent !== ${JSON.stringify(before)} && /kp=60/.test(document.getElementById('lab-command').textContent)`)
  await page.goto(address + '#lab=bode')
  await until(page, 'no margins are told', () => /margin/.test(document.getElementById('lab-words').textContent))
  await page.fill('[name=systems]', 'K11*(')
  await until(page, 'what is no formula is not told', () => !document.getElementById('lab-problem').hidden)
  await page.goto(address + '#lab=lesson-1')
  await until(page, 'no question is asked', () => document.querySelector('[name=sticks]'))
  const answers = async (kp, sticks) => {
    await page.fill('[name=kp]', kp)
    await page.fill('[name=sticks]', sticks)
    await page.getByText('Check my answer').click()
  }
  await answers('10', '4')
  await until(page, 'a wrong answer is not told', () => /Not yet/.test(document.getElementById('lab-verdict').textContent))
  await answers('18,8', '2.16')
  await until(page, 'a right answer is not told', () => /Right/.test(document.getElementById('lab-verdict').textContent))
  await page.reload()
  await until(page, 'a lesson that was passed is forgotten', () => /Lesson 1 ✓/.test(document.getElementById('lesson-list').textContent))
  // a closed pole is dragged along its branch, and damping and step follow
  await page.goto(address + '#lab=locus')
  await page.fill('[name=systems]', '3(s+6)^2/(s(s+1)^2)')
  await until(page, 'no locus is dragged', () => /damping 0.14/.test(document.querySelector('#lab-drag [role=status]').textContent) && /3\(s\+6\)/.test(document.querySelector('#lab-drag pre').textContent))
  const plane = await page.locator('.locus').boundingBox()
  // the pair at about -0.8 + 5.6j, towards less gain
  const [pole, to] = await page.evaluate(() => {
    const canvas = document.querySelector('.locus'), image = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height)
    const red = []
    for (let n = 0; n < image.data.length; n += 4) if (image.data[n] > 150 && image.data[n + 1] < 60 && image.data[n + 2] < 80) red.push([(n / 4) % canvas.width, Math.floor(n / 4 / canvas.width)])
    const top = red.filter(([, y]) => y < canvas.height / 2 - 30)
    const middle = [0, 1].map(k => top.reduce((sum, at) => sum + at[k], 0) / top.length)
    return [middle, [middle[0], (middle[1] + canvas.height / 2) / 2]]
  })
  await page.mouse.move(plane.x + pole[0], plane.y + pole[1])
  await page.mouse.down()
  await page.mouse.move(plane.x + to[0], plane.y + to[1], { steps: 6 })
  await page.mouse.up()
  await until(page, 'a pole that is dragged changes nothing', () => !/damping 0.14/.test(document.querySelector('#lab-drag [role=status]').textContent) && /^k = 0/.test(document.querySelector('#lab-drag [role=status]').textContent))
  // what takes seconds waits until it is asked for; what was tuned is kept as a rig file
  await page.goto(address + '#lab=tune')
  await page.fill('[name=laws]', 'state')
  await page.click('#lab-form .go')
  await until(page, 'nothing is tuned', () => /picked/.test(document.getElementById('lab-words').textContent) && document.querySelector('#lab-plot img'))
  await page.click('#keep-rig')
  await until(page, 'what was tuned is not kept', () => document.getElementById('rig-title').textContent === 'tuned.toml' && /pan_bandwidth/.test(document.getElementById('rig-text').value))
  await page.context().close()
}

// A rig file: made of a preset, wrong at a line, mended, kept with its comments, drawn with, deleted and had back.
const rigs = async () => {
  const page = await opened(1280, 900)
  await page.goto(address + '#rigs')
  await until(page, 'no presets are listed', () => document.querySelectorAll('#rig-presets a').length > 3)
  await page.fill('#rig-name', 'garage')
  await page.click('#rig-few')
  await until(page, 'no new rig file', () => document.getElementById('rig-title').textContent === 'garage.toml' && /base = "report"/.test(document.getElementById('rig-text').value))
  const text = '# mine\nbase = "report"\n\n[laser]\npower = "heavy" # a pointer\n'
  await page.fill('#rig-text', text)
  await until(page, 'what is wrong is not shown at its line', () => document.querySelector('#rig-lines .wrong')?.textContent === '5')
  await page.getByText('Go to line 5').click()
  check((await page.evaluate(() => document.getElementById('rig-text').selectionStart)) === text.indexOf('"heavy"'), 'the caret is not where it is wrong')
  await page.click('#rig-save')
  await page.click('#rig-presets a >> nth=1')
  await until(page, 'no preset is shown', () => document.getElementById('rig-text').readOnly)
  await page.click('#rig-own a')
  await until(page, 'what was written is lost', () => /heavy/.test(document.getElementById('rig-text').value))
  const right = text.replace('heavy', '0.5mW')
  await page.fill('#rig-text', right)
  await until(page, 'what is right is called wrong', () => document.getElementById('rig-wrong').hidden)
  await page.click('#rig-save')
  await until(page, 'it is not kept', () => document.getElementById('rig-save').textContent === 'Saved')
  const kept = await (await page.request.get(address + 'api/v1/rigs/garage.toml')).json()
  check(kept.toml === right, 'it is not kept as it was written')
  await page.click('#rig-use')
  await until(page, 'nothing is planned with it', () => /--rig=.*garage\.toml/.test(document.getElementById('command').textContent))
  check((await value(page, 'rig')) === 'garage.toml', 'the form does not say which head')
  await page.goto(address + '#rigs=garage.toml')
  await page.click('#rig-delete')
  await page.click('#rig-wrong button')
  await until(page, 'it is not had back', () => document.querySelectorAll('#rig-own a').length === 1)
  await page.context().close()
}

// A camera in a simulated room: what it sees, calibrated, held against that, the head found, drawn over what it sees, and asked for again; a head by corners.
const cameras = async () => {
  const page = await opened(1280, 900)
  await page.goto(address + '#cameras')
  await until(page, 'the pages are not seen', () => document.querySelectorAll('#seen-pages .met').length === 4)
  const pdf = await page.request.get(new URL(await page.getAttribute('#print', 'href'), address).href)
  check(pdf.ok() && (await pdf.body()).subarray(0, 5).toString() === '%PDF-', 'no pages to be printed')
  await page.click('#calibrate')
  await until(page, 'the camera is not calibrated', () => /simulated.toml: Great/.test(document.getElementById('calibrated').textContent))
  await until(page, 'it is not held against that', () => /the calibration holds/.test(document.getElementById('seen-words').textContent))
  await page.click('#find-head')
  await until(page, 'the head is not found', () => document.querySelectorAll('#known-heads li').length === 1)
  await page.click('#known-heads button')
  await until(page, 'a calibration is not deleted', () => document.querySelectorAll('#known-heads li').length === 0)
  await page.click('#calibration-deleted button')
  await until(page, 'a calibration is not had back', () => document.querySelectorAll('#known-heads li').length === 1)
  await page.click('#place-seen')
  await until(page, 'what it sees is not planned', () => /--camera=sim:.*house.png/.test(document.getElementById('command').textContent) && document.getElementById('count').textContent === '28')
  await page.selectOption('[name=head]', 'simulated.toml')
  await until(page, 'the head is not where it was found', () => /--head=.*simulated.toml/.test(document.getElementById('command').textContent) && !document.body.classList.contains('waits'))
  await page.click('#trace')
  await until(page, 'what it sees is not traced', () => /mm off at most/.test(document.getElementById('result').textContent))
  await page.click('#to-runs')
  await until(page, 'its run is not listed', () => /house-camera/.test(document.getElementById('run-list').textContent))
  await page.click('[aria-label="Place again: house-camera"]')
  await until(page, 'what it saw cannot be asked for again', () => /Camera: sim:house.png/.test(document.getElementById('name').textContent) && !document.body.classList.contains('waits'))
  await page.goto(address + '#cameras=corners')
  await page.check('#corners-simulate')
  await page.fill('#corners-width', '3x')
  await page.click('#find-corners')
  await until(page, 'a wrong width is not told', () => /use one of m, mm, cm/.test(document.getElementById('cameras-problem').textContent))
  await page.fill('#corners-width', '3m')
  await page.click('#find-corners')
  await until(page, 'no head is found by corners', () => /head.toml/.test(document.getElementById('corners-found').textContent))
  await page.context().close()
  // who comes next begins with a picture again
  await (await opened(1280, 900)).context().close()
}

const looks = async () => {
  for (const [width, height] of [[1280, 800], [820, 1100], [390, 844]]) {
    for (const theme of ['light', 'dark', 'room']) {
      const page = await opened(width, height)
      await page.evaluate(name => localStorage.setItem('theme', name), theme)
      for (const view of ['', '#run', '#runs', '#compare=house,house-2', '#lab', '#lab=locus', '#lab=lesson-2', '#rigs=garage.toml', '#cameras', '#cameras=corners', '#devices']) {
        // a page that is new
        await page.goto('about:blank')
        await page.goto(address + view)
        await page.waitForTimeout(400)
        if (view === '#devices') await page.click('#invite-viewer')
        await page.evaluate(axe)
        const { violations } = await page.evaluate(() => globalThis.axe.run())
        for (const v of violations) complaints.push(`${width} px, ${theme}, ${view || 'place'}: ${v.id}, ${v.nodes.length} times: ${v.nodes[0].html.slice(0, 120)}`)
        const wide = await page.evaluate(() => document.documentElement.scrollWidth)
        check(wide <= width, `${width} px, ${theme}: ${wide} px wide`)
      }
      await page.context().close()
    }
  }
}

const took = await firstMinute()
await place()
await onWall()
const stopped = await attend()
const dark = await lost()
await steps()
await history()
await lab()
await rigs()
await cameras()
const far = await devices()
if (process.argv[4]) await port(process.argv[4])
await keys()
await looks()
await browser.close()
for (const complaint of complaints) console.error(complaint)
if (complaints.length) process.exit(1)
console.log(`the studio was used: the house is traced ${took} s after a click, stopped ${stopped} ms after one on another page, ${far} ms after one on another device, dark ${dark} ms after its operator was lost`)
