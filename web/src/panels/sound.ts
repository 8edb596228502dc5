// The motor's force as sound. Slow swings are played faster and quick ones slower, and over and over, so that they can be heard; the words say
// how much.

let context: AudioContext | null = null
let source: AudioBufferSourceNode | null = null

const lowest = 150 // Hz that is heard well, at least
const highest = 2000 // at most
const longEnough = 2 // s
const mostTimes = 50

export interface Heard {
  faster: number // than it is; below 1 slower
  times: number // over, so that it lasts
}
/** How a run of that duration is played that swings at that frequency; null: at none. */
export function heard(duration: number, frequency: number | null): Heard {
  const factor = frequency === null || !(frequency > 0) ? 1 : frequency < lowest ? lowest / frequency : Math.min(1, highest / frequency)
  const faster =
    factor === 1 ? 1 : Math.min(64, Math.max(1 / 64, 2 ** (factor > 1 ? Math.ceil(Math.log2(factor)) : Math.floor(Math.log2(factor)))))
  return { faster, times: Math.min(mostTimes, Math.max(1, Math.ceil((longEnough * faster) / duration))) }
}
export function heardWord({ faster, times }: Heard): string {
  const speed =
    faster === 1 ? 'as fast as it is' : faster > 1 ? `${faster} times faster than it is` : `${1 / faster} times slower than it is`
  return `${speed}, to be heard${times > 1 ? `; ${times} times over` : ''}`.replace('as fast as it is, to be heard', 'as fast as it is')
}

export function stop(): void {
  source?.stop()
  source = null
}

/** Plays it once; returns what is heard, in words. */
export function play(force: readonly number[], time: readonly number[], frequency: number | null, ended: () => void): string {
  stop()
  context ??= new AudioContext()
  const period = (time.at(-1)! - time[0]!) / Math.max(1, time.length - 1)
  const plan = heard(period * (time.length - 1), frequency)
  const { faster, times } = plan
  const rate = context.sampleRate
  const whole = force.length * period
  // Over and over it swings on where it ended: whole swings, where there are any.
  const swings = times > 1 && frequency !== null ? Math.floor(whole * frequency) : 0
  const once = Math.max(1, Math.floor(((swings > 0 ? swings / frequency! : whole) * rate) / faster))
  const length = times > 1 ? once * times : Math.min(once, rate * 10)
  const buffer = context.createBuffer(1, length, rate)
  const samples = buffer.getChannelData(0)
  const mean = force.reduce((sum, each) => sum + each, 0) / force.length
  const peak = force.reduce((most, each) => Math.max(most, Math.abs(each - mean)), 0) || 1
  for (let i = 0; i < length; ++i) {
    const at = ((i % once) / rate / period) * faster
    const k = Math.floor(at)
    const a = force[Math.min(k, force.length - 1)]!
    const b = force[Math.min(k + 1, force.length - 1)]!
    const fade = Math.min(1, i / 200, (length - i) / 200)
    samples[i] = ((a + (b - a) * (at - k) - mean) / peak) * 0.3 * fade
  }
  source = context.createBufferSource()
  source.buffer = buffer
  source.connect(context.destination)
  source.onended = ended
  source.start()
  return heardWord(plan)
}
