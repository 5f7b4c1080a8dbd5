// The chip: a program of the firmware's test double, its pins, its line to a host.

import { readFileSync } from 'node:fs'
import { GPIOPinState, RP2040 } from 'rp2040js'
import { SimulationClock } from './node_modules/rp2040js/dist/esm/clock/simulation-clock.js'
import { computeInFloat, runPioByTheClock, startWithoutBootRom, waitForTheHostsBytes } from './mends.mjs'

// The chip's clock, ns a cycle: what its peripherals run by.
const CYCLE_NS = 8
// Its processor is a smaller one than that of an RP2350: run so much faster, a tick takes about as long as on an emulated one (70 µs). That proves nothing about time.
const PROCESSOR_NS = CYCLE_NS / 4
// Instructions are run for so long between two looks at the clock, ns.
const LOOK_NS = 100
// Time until PIO has told an edge, ns.
const TOLD_NS = 500
const PROGRAM = 0x10000100
const WATCHDOG = 0x40058
// bytes that wait for the chip
const ROOM = 400

export class Chip {
  constructor(image) {
    this.clock = new SimulationClock()
    this.mcu = new RP2040(this.clock)
    const quiet = () => {}
    this.mcu.logger = { debug: quiet, info: quiet, warn: quiet, error: quiet }
    this.mcu.onBreak = code => {
      throw new Error(`the program stopped at ${this.mcu.core.PC.toString(16)} (${code})`)
    }
    this.mcu.flash.fill(0xff)
    this.mcu.flash.set(readFileSync(`${image}.bin`))
    computeInFloat(this.mcu, JSON.parse(readFileSync(`${image}.json`)))
    this.line = waitForTheHostsBytes(this.mcu)
    this.pio = runPioByTheClock(this.mcu, this.mcu.pio[0], CYCLE_NS)
    // time of instructions that the clock was not told yet, ns: it counts whole ones, or its timers come to nearly the time that they wait for, for ever
    this.passed = 0
    this.said = []
    this.waiting = []
    this.line.onSerialData = bytes => this.said.push(Buffer.from(bytes))
    // When the watchdog reset it, ns: its pins are let go then, and it stands.
    this.resetAt = null
    const watchdog = this.mcu.peripherals[WATCHDOG]
    watchdog.onWatchdogTrigger = () => {
      this.resetAt ??= this.clock.nanos
      watchdog.alarm.enable = false
    }
    this.settles = this.clock.createAlarm(() => this.pio(this.clock.nanos))
    startWithoutBootRom(this.mcu, PROGRAM)
  }

  get now() {
    return this.clock.nanos
  }

  // Whether a pin that the program drives is high.
  isHigh(pin) {
    return this.resetAt === null && this.mcu.gpio[pin].value === GPIOPinState.High
  }

  // Calls back when a pin changes, with whether it is high.
  watch(pin, changed) {
    this.mcu.gpio[pin].addListener(state => changed(state === GPIOPinState.High))
  }

  // Drives a pin from outside.
  set(pin, isHigh) {
    this.mcu.gpio[pin].setInputValue(isHigh)
  }

  // Drives a pin that PIO looks at: what it saw until now is settled first.
  setSeen(pin, isHigh) {
    this.pio(this.now)
    this.set(pin, isHigh)
    this.settles.schedule(TOLD_NS)
  }

  // The share of its period for which each of both outputs of a slice is high.
  duties(slice) {
    const { alarmA, alarmB, timer, csr } = this.mcu.pwm.channels[slice]
    const share = target => Math.min(1, target / (timer.top + 1))
    return csr & 1 ? [share(alarmA.target), share(alarmB.target)] : [0, 0]
  }

  // Calls back after so many ns.
  after(ns, what) {
    this.clock.createAlarm(what).schedule(Math.round(ns))
  }

  // Calls back every so many ns.
  every(ns, what) {
    const alarm = this.clock.createAlarm(() => {
      alarm.schedule(ns)
      what()
    })
    alarm.schedule(ns)
  }

  // Bytes of the host.
  take(bytes) {
    this.waiting.push(...bytes)
  }

  // Lets time pass, ns; what was said meanwhile.
  run(ns) {
    const { clock, mcu, line, waiting } = this
    const { core } = mcu
    const until = clock.nanos + ns
    while (clock.nanos < until && this.resetAt === null) {
      while (waiting.length > 0 && line.txFIFO.itemCount < ROOM) line.sendSerialByte(waiting.shift())
      line.fill()
      let left = Math.min(until, mcu.clock.nextAlarm?.nanos ?? until) - clock.nanos
      if (core.waiting) {
        clock.tick(Math.max(left, CYCLE_NS))
        continue
      }
      left = Math.min(left, LOOK_NS)
      do this.passed += core.executeInstruction() * PROCESSOR_NS
      while (this.passed < left && !core.waiting)
      const whole = Math.floor(this.passed)
      this.passed -= whole
      clock.tick(whole)
    }
    if (clock.nanos < until) clock.tick(until - clock.nanos)
    return Buffer.concat(this.said.splice(0))
  }
}
