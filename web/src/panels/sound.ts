// The motor's force as sound. Slow swings are played faster, so that they can be heard; the words say how much.

let context: AudioContext | null = null
let source: AudioBufferSourceNode | null = null

const audible = 150 // Hz, at least

export function stop(): void {
  source?.stop()
  source = null
}

/** Plays it once; returns what is heard, in words. */
export function play(force: readonly number[], time: readonly number[], frequency: number | null, ended: () => void): string {
  stop()
  context ??= new AudioContext()
  const period = (time.at(-1)! - time[0]!) / Math.max(1, time.length - 1)
  const faster =
    frequency !== null && frequency > 0 && frequency < audible ? Math.min(64, 2 ** Math.ceil(Math.log2(audible / frequency))) : 1
  const rate = context.sampleRate
  const length = Math.min(Math.max(1, Math.floor((force.length * period * rate) / faster)), rate * 10)
  const buffer = context.createBuffer(1, length, rate)
  const samples = buffer.getChannelData(0)
  const mean = force.reduce((sum, each) => sum + each, 0) / force.length
  const peak = force.reduce((most, each) => Math.max(most, Math.abs(each - mean)), 0) || 1
  for (let i = 0; i < length; ++i) {
    const at = (i / rate / period) * faster
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
  return faster === 1 ? 'as it would sound' : `${faster} times faster than it is, to be heard`
}
