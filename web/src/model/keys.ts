// The numbers of a device file as the page names them; the rest of the table of keys is the program's (tests/rules/device_keys.py).

import keys from './device_keys.json'
import { find, samePath, scan, type Scan, type TomlValue } from './toml'

export interface Field {
  key: string
  label: string
  unit: [linear: string, rotary: string]
  about: string
  mayBeZero: boolean
  first: [linear: number, rotary: number] // where a slider begins when the number is 0
  mayBeAbsent?: string // emptied, it is taken out of the file; then this holds
  like?: string // the key whose number holds while it is absent
  ofRig?: 'number' | 'choice' // no limit feels it: nothing to slide or follow; a choice is not stepped either
  travel?: Travel // of a joint: its slider has even steps
}

/** From where to where a joint is moved here, and where it is while the file does not say; m or rad. */
export interface Travel {
  from: number
  to: number
  at: number
}

/** A joint that gives the pose of a mechanism, as the program's answer lists them. */
export interface Joint {
  name: string
  unit: string
  position: number
  range: number[] | null
}

type Pair = [linear: number, rotary: number]

// Where the page says it in other words than the file, and where a slider begins otherwise than its unit does.
const shown: Record<string, { label?: string; first?: Pair }> = {
  'body.damping': { first: [0.1, 1e-4] },
  'body.stiffness': { first: [10, 1e-2] },
  'body.coulomb': { label: 'dry friction', first: [0.1, 1e-3] },
  'loop.sampling_period': { first: [1e-3, 1e-3] },
  'actuator.time_constant': { label: 'lag' },
  'actuator.force_limit': { label: 'largest force' },
  'sensor.resolution': { label: 'encoder step' },
  'wall.stiffness': { label: 'stiffness K' },
  'wall.damping': { label: 'damping B' },
  'wall.velocity_filter_hz': { label: 'velocity filter' },
  'wall.filter.frequency_hz': { label: 'frequency' },
  'wall.filter.damping_ratio': { first: [0.7, 0.7] },
  'wall.filter.depth': { first: [0.1, 0.1] },
  'operator.stiffness': { first: [100, 0.1] },
  'driver.travel': { first: [0.025, 6.2832] },
  'driver.sign': { first: [-1, -1] },
  'driver.force_sign': { first: [-1, -1] },
  'driver.id': { first: [1, 1] },
  'driver.command': { first: [0, 0] },
  'driver.baud': { first: [921600, 921600] },
}
const firsts: Record<string, Pair> = {
  kg: [0.1, 1e-4],
  'N s/m': [1, 1e-3],
  'N/m': [1e3, 1],
  N: [10, 0.1],
  m: [1e-6, 1e-4],
  s: [1e-4, 1e-4],
  Hz: [100, 100],
  'N m/A': [0.05, 0.05],
  'N m/V': [0.1, 0.1],
}

/** The numbers of a table of the device file, and every key of the rig's; what stands for another key is left out. */
function fieldsOf(path: string): Field[] {
  const ofRig = path === 'driver'
  return keys
    .filter((each) => each.table === path && each.same_as === '' && (ofRig || each.type === 'number'))
    .map((each): Field => {
      const own = shown[`${path}.${each.key}`]
      const like = /^`([\w.]+)`$/.exec(each.default)?.[1]
      return {
        key: each.key,
        label: own?.label ?? each.key.replaceAll('_', ' '),
        unit: [each.unit?.linear ?? '', each.unit?.rotary ?? ''],
        about: each.help.replaceAll("'", '’'),
        mayBeZero: each.takes_zero,
        first: own?.first ?? firsts[each.unit?.linear ?? ''] ?? [2, 2],
        ...((ofRig || like || each.default === 'none') && { mayBeAbsent: like ? 'the loop’s' : each.default.replaceAll("'", '’') }),
        ...(like && { like }),
        ...(ofRig && { ofRig: each.type === 'number' ? 'number' : 'choice' }),
      }
    })
}

const [body, link, loop, damper, actuator, sensor] = [
  fieldsOf('body'),
  fieldsOf('link'),
  fieldsOf('loop'),
  fieldsOf('loop.damper'),
  fieldsOf('actuator'),
  fieldsOf('sensor'),
]
const transmission = fieldsOf('transmission')
const [wall, filter, operator, driver] = [fieldsOf('wall'), fieldsOf('wall.filter'), fieldsOf('operator'), fieldsOf('driver')]
// What a mass is called in a rotary device.
const inertias = new Map(
  [...body, ...operator].filter((each) => each.key === 'mass').map((each): [Field, Field] => [each, { ...each, label: 'inertia' }]),
)

export interface Row {
  key: string // as --set and the documents name it: body.motor.mass
  path: string[]
  field: Field
  unit: string
  group: string
  value: TomlValue | undefined // absent: the default of the file
}

export interface Group {
  id: string // body.motor, link.0, loop
  title: string
  rows: Row[]
}

/** The text of a value that stands at a path. */
export const textAt = (scanned: Scan, ...path: string[]): string | undefined => {
  const value = find(scanned, path)?.value
  return typeof value === 'string' ? value : undefined
}

export const countOf = (scanned: Scan, ...path: string[]): number =>
  new Set(
    scanned.tables
      .filter((each) => each.path.length === path.length + 1 && path.every((part, i) => each.path[i] === part))
      .map((each) => each.path.at(-1)),
  ).size

export const isRotary = (scanned: Scan): boolean => textAt(scanned, 'motion') === 'rotary'

export interface Shape {
  bodies: string[]
  links: [string, string][]
  actuated: string | undefined
  sensed: string | undefined
  held: string | undefined
  hasTransferFunction: boolean
  mechanism: MechanismShape | null
}

/** What the file says of a mechanism. */
export interface MechanismShape {
  text: string // of its own file, here
  file: string // that it names, which nobody but its user can read
  tip: string
  normal: number[] | null // null: no three numbers
  isPoint: boolean // a wall in every direction
}

function mechanismOf(scanned: Scan): MechanismShape | null {
  if (!scanned.tables.some((each) => each.path[0] === 'mechanism')) return null
  const normal = find(scanned, ['mechanism', 'normal'])?.value
  const numbers = Array.isArray(normal) ? normal.map(Number) : []
  return {
    text: textAt(scanned, 'mechanism', 'text') ?? '',
    file: textAt(scanned, 'mechanism', 'file') ?? '',
    tip: textAt(scanned, 'mechanism', 'tip') ?? '',
    normal: numbers.length === 3 && numbers.every(Number.isFinite) ? numbers : null,
    isPoint: normal === 'all',
  }
}

export function shapeOf(scanned: Scan): Shape {
  const bodies = Array.from({ length: countOf(scanned, 'body') }, (_, i) => textAt(scanned, 'body', String(i), 'name') ?? String(i))
  const links = Array.from({ length: countOf(scanned, 'link') }, (_, i): [string, string] => {
    const between: TomlValue = find(scanned, ['link', String(i), 'between'])?.value ?? []
    return Array.isArray(between) ? [String(between[0] ?? ''), String(between[1] ?? '')] : ['', '']
  })
  return {
    bodies,
    links,
    actuated: textAt(scanned, 'loop', 'actuated') ?? bodies[0],
    sensed: textAt(scanned, 'loop', 'sensed') ?? bodies[0],
    held: textAt(scanned, 'loop', 'held') ?? bodies.at(-1),
    hasTransferFunction: scanned.tables.some((each) => each.path[0] === 'transfer_function'),
    mechanism: mechanismOf(scanned),
  }
}

const jointFields = new Map<string, Field>()
/** The position of a joint; the same one as long as the joint is where it was, so that its row is not drawn again. */
function fieldOfJoint(joint: Joint): Field {
  const { name, unit, position, range } = joint
  const id = JSON.stringify(joint)
  const known = jointFields.get(id)
  if (known) return known
  const [from, to] = [range?.[0], range?.[1]]
  const around = unit === 'm' ? 0.1 : Math.PI
  const middle = 2 * around * Math.round(position / (2 * around)) // stays where it is as the joint moves
  const travel = from !== undefined && to !== undefined && from < to ? { from, to } : { from: middle - around, to: middle + around }
  const field: Field = {
    key: name,
    label: name,
    unit: [unit, unit],
    about: `Position of the joint${range ? '' : '; its file gives no range'}`,
    mayBeZero: true,
    first: [0.1, 0.1],
    mayBeAbsent: 'as it follows from the file',
    travel: { ...travel, at: position },
  }
  if (jointFields.size > 2000) jointFields.clear()
  jointFields.set(id, field)
  return field
}

/** The joints that the answer lists, then others that the file names. */
function jointsOf(scanned: Scan, known: Joint[]): Joint[] {
  const named = scanned.entries
    .filter(({ path }) => path[0] === 'mechanism' && path[1] === 'pose' && path.length === 3)
    .map(({ path }) => path[2]!)
  const others = named.filter((name) => known.every((each) => each.name !== name))
  return [...known, ...others.map((name): Joint => ({ name, unit: 'rad', position: 0, range: null }))]
}

/** The old one where it is the same, so that what shows it is not drawn again. */
function sharing(group: Group, before: Group[]): Group {
  const old = before.find((each) => each.id === group.id)
  if (!old) return group
  const rows = group.rows.map((row, i) => {
    const was = old.rows[i]
    return was &&
      was.key === row.key &&
      was.value === row.value &&
      was.field === row.field &&
      was.unit === row.unit &&
      samePath(was.path, row.path)
      ? was
      : row
  })
  return old.title === group.title && old.rows.length === rows.length && rows.every((row, i) => row === old.rows[i])
    ? old
    : { ...group, rows }
}

/** Every number of the file and those that may be added, in groups as the schematic shows them; what is as `before` is the same object. */
export function groupsOf(scanned: Scan, before: Group[] = [], joints: Joint[] = []): Group[] {
  const side = isRotary(scanned) ? 1 : 0
  const shape = shapeOf(scanned)
  const group = (id: string, title: string, path: string[], fields: Field[]): Group => ({
    id,
    title,
    rows: fields.map((given): Row => {
      const field = (side === 1 && inertias.get(given)) || given
      const inertia = field.key === 'mass' ? find(scanned, [...path, 'inertia']) : undefined
      const own = inertia?.path ?? [...path, field.key]
      return { key: `${id}.${field.key}`, path: own, field, unit: field.unit[side], group: id, value: find(scanned, own)?.value }
    }),
  })
  const ofMechanism = shape.mechanism && [
    group('mechanism.pose', 'Pose', ['mechanism', 'pose'], jointsOf(scanned, joints).map(fieldOfJoint)),
    ...Array.from({ length: countOf(scanned, 'transmission') }, (_, i) => {
      const joint = textAt(scanned, 'transmission', String(i), 'joint') ?? String(i)
      return group(`transmission.${i}`, `Motor behind joint “${joint}”`, ['transmission', String(i)], transmission)
    }),
  ]
  const groups = [
    ...(ofMechanism ?? []),
    ...shape.bodies.map((name, i) => group(`body.${name}`, `Body “${name}”`, ['body', String(i)], body)),
    ...shape.links.map(([a, b], i) => group(`link.${i}`, `Link ${a} – ${b}`, ['link', String(i)], link)),
    group('loop', 'Loop', ['loop'], loop),
    group('loop.damper', 'Damper’s own loop', ['loop', 'damper'], damper),
    group('wall', 'Wall', ['wall'], wall),
    ...Array.from({ length: countOf(scanned, 'wall', 'filter') }, (_, i) => {
      const type = textAt(scanned, 'wall', 'filter', String(i), 'type') ?? ''
      const all = group(`wall.filter.${i}`, `Wall filter ${i + 1}: ${type.replace('_', ' ')}`, ['wall', 'filter', String(i)], filter)
      return { ...all, rows: all.rows.filter((row) => row.value !== undefined) }
    }),
    group('actuator', 'Motor', ['actuator'], actuator),
    group('sensor', 'Encoder', ['sensor'], sensor),
  ]
  if (!shape.hasTransferFunction) groups.push(group('operator', 'User who holds it', ['operator'], operator))
  groups.push(group('driver', 'Drive of a rig', ['driver'], driver))
  return groups.map((each) => sharing(each, before))
}

const devices = new Map<string, string>()
/** The same for one device whose numbers differ; another for another device. */
export function deviceKey(toml = ''): string {
  let key = devices.get(toml)
  if (key === undefined) {
    const scanned = scan(toml)
    const { mechanism, ...shape } = shapeOf(scanned)
    key = JSON.stringify([textAt(scanned, 'name'), isRotary(scanned), shape, mechanism?.text, mechanism?.file, mechanism?.tip])
    if (devices.size > 20) devices.clear()
    devices.set(toml, key)
  }
  return key
}

/** link.stiffness and link.0.stiffness are one, as are mass and inertia. */
export const fullKey = (key: string): string => key.replace(/^link\.(?=[a-z])/, 'link.0.').replace(/\.inertia$/, '.mass')
export const sameKey = (a: string, b: string): boolean => a === b || fullKey(a) === fullKey(b)

/** The period that must be a whole part or multiple of this one; nothing of other numbers. */
export const otherPeriod = (key: string): string =>
  ({ 'loop.sampling_period': 'loop.damper.sampling_period', 'loop.damper.sampling_period': 'loop.sampling_period' })[key] ?? ''

/** What the page calls a number: "Body “motor”: mass". */
export const titleOf = (group: Group, row: Row): string => `${group.title}: ${row.field.label}`

/** A text of the program with the page's names in place of the file's keys. */
export function inWords(text: string, groups: Group[]): string {
  if (!/[a-z]\.[^\s]*[a-z]/.test(text)) return text
  const names = groups.flatMap((group) => group.rows.map((row): [string, string] => [row.key, titleOf(group, row)]))
  for (const [key, name] of names.sort(([a], [b]) => b.length - a.length)) text = text.replaceAll(key, name)
  return text
}
