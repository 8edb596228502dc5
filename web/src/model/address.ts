// The whole state in the address: JSON, deflated against the words of a device file, behind the CRC-32 of that, as base64url.

import { deflateSync, inflateSync, strFromU8, strToU8 } from 'fflate'
import type { Pin, Settings, Snapshot } from './snapshot'
import { withoutComments } from './toml'

export const longestAddress = 2048

// What both ends know. Changing it breaks every shared link: a new one needs a new version letter.
const dictionary = strToU8(
  '"relayAmplitude":""oscillatesHz":""targetAnyUser":true"sweepFrom":""sweepTo":""phaseMarginDeg":""gainMarginDb":""userForce":""duration":""contact":"unilateral"' +
    '[transfer_function]\\nnumerator = [1.0]\\ndenominator = [\\n[uncertainty]\\nverdict = \\"doubtful\\"\\nparameters = [covariance = [\\nreasons = [\\"' +
    '\\n\\n[operator]\\nmass = 0.0\\ndamping = 0.0\\nstiffness = 0.0\\n[[wall.filter]]\\ntype = \\"notch\\"\\nfrequency_hz = \\ndamping_ratio = \\ndepth = ' +
    '[actuator]\\ntime_constant = \\nforce_limit = \\n\\n[sensor]\\nresolution = \\nvelocity_filter_hz = \\n[wall]\\nstiffness = \\ndamping = ' +
    'name = \\"\\"\\nmotion = \\"rotary\\"\\nmotion = \\"linear\\"\\n\\n[[body]]\\nname = \\"motor\\"\\nmass = 0.3\\ninertia = \\ndamping = 0.1\\ncoulomb = ' +
    '\\n\\n[[body]]\\nname = \\"handle\\"\\nmass = 5.1\\ndamping = 3.4\\n\\n[[link]]\\nbetween = [\\"motor\\", \\"handle\\"]\\nstiffness = 79.5e3\\ndamping = 15.0\\n\\n' +
    '[loop]\\nactuated = \\"motor\\"\\nsensed = \\"motor\\"\\nheld = \\"handle\\"\\nsampling_period = 1e-3\\ndelay = 0.0\\n["',
)

const version = 'b' // 'a' had no checksum

export interface Address {
  text: string
  left: 'nothing' | 'comments' | 'pins' // left out to keep it short
}

/** At most longestAddress characters; null where even the bare design is longer. */
export function encode(state: Snapshot): Address | null {
  const bare = { ...state, toml: withoutComments(state.toml), pins: state.pins.map((pin) => ({ ...pin, toml: withoutComments(pin.toml) })) }
  const tries: [Snapshot, Address['left']][] = [
    [state, 'nothing'],
    [bare, 'comments'],
    [{ ...bare, pins: [] }, 'pins'],
  ]
  for (const [each, left] of tries) {
    const json = JSON.stringify([each.toml, each.pins.map((pin) => [pin.name, pin.toml]), each.locks, each.settings])
    const packed = deflateSync(strToU8(json), { level: 9, dictionary })
    const text = version + toBase64Url(new Uint8Array([...checksum(packed), ...packed]))
    if (text.length <= longestAddress) return { text, left }
  }
  return null
}

export type Decoded = { state: Snapshot } | { problem: string }

/** What the text holds, or what is wrong with it. */
export function decode(text: string): Decoded {
  const given = text.slice(0, 1)
  if (given < version && given >= 'a') return { problem: 'it is of an older version of the program' }
  if (given > version && given <= 'z') return { problem: 'it is of a newer version of the program' }
  const damaged = { problem: 'it was changed or cut off on its way' }
  if (given !== version || text.length > longestAddress) return damaged
  try {
    const bytes = fromBase64Url(text.slice(1))
    const packed = bytes.subarray(4)
    if (toBase64Url(bytes) !== text.slice(1) || checksum(packed).some((each, i) => each !== bytes[i])) return damaged
    const json: unknown = JSON.parse(strFromU8(inflateSync(packed, { dictionary })))
    if (!Array.isArray(json)) return damaged
    const [toml, pins, locks, settings] = json as unknown[]
    if (typeof toml !== 'string' || !isPins(pins) || !isTexts(locks) || !isSettings(settings)) return damaged
    return { state: { toml, pins: pins.map(([name, own]): Pin => ({ name, toml: own })), locks, settings } }
  } catch {
    return damaged
  }
}

/** CRC-32 (ISO 3309, as in PNG), big endian. */
function checksum(bytes: Uint8Array): Uint8Array {
  let crc = 0xffffffff
  for (const byte of bytes) {
    crc ^= byte
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0)
  }
  return new Uint8Array([24, 16, 8, 0].map((shift) => (~crc >>> shift) & 0xff))
}

const isTexts = (value: unknown): value is string[] => Array.isArray(value) && value.every((each) => typeof each === 'string')
const isPins = (value: unknown): value is [string, string][] =>
  Array.isArray(value) && value.every((each) => isTexts(each) && each.length === 2)
const isSettings = (value: unknown): value is Settings =>
  typeof value === 'object' &&
  value !== null &&
  !Array.isArray(value) &&
  Object.values(value).every((each) => typeof each === 'string' || each === true)

function toBase64Url(bytes: Uint8Array): string {
  let binary = ''
  for (const byte of bytes) binary += String.fromCharCode(byte)
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')
}

function fromBase64Url(text: string): Uint8Array {
  const binary = atob(text.replaceAll('-', '+').replaceAll('_', '/'))
  return Uint8Array.from(binary, (c) => c.charCodeAt(0))
}
