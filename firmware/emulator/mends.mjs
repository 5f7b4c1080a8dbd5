// What the emulator lacks, put beside it: each function is named for what it mends. The firmware is as it is.

import { USBCDC } from 'rp2040js'

// bits of a buffer's control word in the USB controller's memory
const AVAILABLE = 1 << 10
const FIRST_OUT = 0x84
const LAST = 0xfc
// a machine of PIO may go round in so many instructions when nothing happens
const MOST_ROUND = 64
const CTRL = 0
const FLASH = 0x10000000

// The boot ROM is not there, and not needed: the program's own vectors say where it begins.
export const startWithoutBootRom = (chip, from) => {
  chip.core.VTOR = from
  chip.core.SP = chip.readUint32(from)
  chip.core.PC = chip.readUint32(from + 4) & ~1
}

// PIO runs by the host's timers, whatever the time and the divider: here it runs by the chip's clock, as far as somebody looks. A machine that goes
// round and round with nothing but a counter changing is carried over whole rounds.
export const runPioByTheClock = (chip, pio, cycleNs) => {
  const began = new Map()
  pio.run = () => {}
  const write = pio.writeUint32.bind(pio)
  const until = now => {
    for (const [machine, start] of began) runMachine(pio, machine, start.cycles + Math.floor((now - start.ns) / cycleNs))
  }
  pio.writeUint32 = (offset, value) => {
    until(chip.clock.nanos)
    write(offset, value)
    if (offset !== CTRL) return
    for (const machine of pio.machines) {
      if (machine.enabled && !began.has(machine)) began.set(machine, { ns: chip.clock.nanos, cycles: machine.cycles })
      if (!machine.enabled) began.delete(machine)
    }
  }
  return until
}

const runMachine = (pio, machine, until) => {
  while (machine.cycles < until) {
    const { pc, x, y, outputShiftReg, inputShiftReg, cycles } = machine
    const held = machine.rxFIFO.itemCount
    let steps = 0
    do {
      machine.step()
      steps++
    } while (machine.cycles < until && machine.pc !== pc && steps < MOST_ROUND)
    const isSame = machine.pc === pc && machine.y === y && machine.outputShiftReg === outputShiftReg && machine.inputShiftReg === inputShiftReg
    if (isSame && machine.rxFIFO.itemCount === held && !machine.waiting) {
      const round = machine.cycles - cycles
      const rounds = Math.max(0, Math.floor((until - machine.cycles) / round))
      machine.cycles += rounds * round
      machine.x = (machine.x + rounds * ((machine.x - x) | 0)) >>> 0
    }
  }
  pio.checkChangedPins()
}

// A buffer that is to be filled by the host counts as filled from the moment it is offered, and a host with nothing to say fills it with nothing.
export const waitForTheHostsBytes = chip => {
  const { usbCtrl: usb, usbDPRAMView: memory } = chip
  const line = new USBCDC(usb)
  const offered = usb.DPRAMUpdated.bind(usb)
  const filled = usb.finishRead.bind(usb)
  const asked = usb.onEndpointRead
  usb.DPRAMUpdated = (offset, value) => {
    const isOut = offset >= FIRST_OUT && offset <= LAST && offset % 8 === 4 && value & AVAILABLE
    offered(offset, value)
    if (isOut) memory.setUint32(offset, memory.getUint32(offset, true) | AVAILABLE, true)
  }
  usb.finishRead = (endpoint, bytes) => {
    const at = FIRST_OUT + 8 * endpoint
    memory.setUint32(at, memory.getUint32(at, true) & ~AVAILABLE, true)
    filled(endpoint, bytes)
  }
  let waits = null
  usb.onEndpointRead = (endpoint, size) => {
    if (endpoint === line.outEndpoint && line.txFIFO.itemCount === 0) waits = [endpoint, size]
    else asked(endpoint, size)
  }
  line.fill = () => {
    if (!waits || line.txFIFO.itemCount === 0) return
    const [endpoint, size] = waits
    waits = null
    asked(endpoint, size)
  }
  return line
}

const BREAK = 0xbe00
const RETURN = 0x4770
const words = new Uint32Array(2)
const floats = new Float32Array(words.buffer)
const whole = (value, least, most) => Number.isNaN(value) ? 0 : Math.trunc(Math.min(most, Math.max(least, value)))
const compared = is => { words[0] = is ? 1 : 0 }
// Routines of f32, which leave their answer in the first word. What JavaScript computes in f64 and rounds is what IEEE 754 has for f32.
const FLOATS = {
  __aeabi_fadd: (a, b) => { floats[0] = a + b },
  __aeabi_fsub: (a, b) => { floats[0] = a - b },
  __aeabi_fmul: (a, b) => { floats[0] = a * b },
  __aeabi_fdiv: (a, b) => { floats[0] = a / b },
  __aeabi_fcmpeq: (a, b) => compared(a === b),
  __aeabi_fcmplt: (a, b) => compared(a < b),
  __aeabi_fcmple: (a, b) => compared(a <= b),
  __aeabi_fcmpge: (a, b) => compared(a >= b),
  __aeabi_fcmpgt: (a, b) => compared(a > b),
  __aeabi_fcmpun: (a, b) => compared(Number.isNaN(a) || Number.isNaN(b)),
  __aeabi_f2iz: a => { words[0] = whole(a, -(2 ** 31), 2 ** 31 - 1) },
  __aeabi_f2uiz: a => { words[0] = whole(a, 0, 2 ** 32 - 1) },
  __aeabi_i2f: (_a, _b, word) => { floats[0] = word | 0 },
  __aeabi_ui2f: (_a, _b, word) => { floats[0] = word >>> 0 },
}

// The chip that ships computes f32 by itself. This one does it by routines, five sixths of a tick: they are answered at once, with the same bits.
export const computeInFloat = (chip, routines) => {
  const doers = []
  for (const [name, at] of Object.entries(routines)) {
    const doer = FLOATS[name]
    if (!doer) throw new Error(`${name} is not known to compute anything`)
    chip.flashView.setUint16(at - FLASH, BREAK | doers.length, true)
    chip.flashView.setUint16(at - FLASH + 2, RETURN, true)
    doers.push(doer)
  }
  const stopped = chip.onBreak
  chip.onBreak = code => {
    const doer = doers[code]
    if (!doer) return stopped(code)
    const { registers } = chip.core
    words[0] = registers[0]
    words[1] = registers[1]
    doer(floats[0], floats[1], words[0])
    registers[0] = words[0]
  }
}
