// The numbers of a device file: their names, units and a word on each. What is allowed, the server says.

import { find, samePath, scan, type Scan, type TomlValue } from './toml'

export interface Field {
  key: string
  label: string
  unit: [linear: string, rotary: string]
  about: string
  mayBeZero: boolean
  first: [linear: number, rotary: number] // where a slider begins when the number is 0
  mayBeAbsent?: string // emptied, it is taken out of the file; then this holds
  ofRig?: 'number' | 'choice' // no limit feels it: nothing to slide or follow; a choice is not stepped either
}

const mass: Field = {
  key: 'mass',
  label: 'mass',
  unit: ['kg', 'kg m²'],
  about: 'Mass of the body; of a rotary device its moment of inertia.',
  mayBeZero: false,
  first: [0.1, 1e-4],
}
const damping: Field = {
  key: 'damping',
  label: 'damping',
  unit: ['N s/m', 'N m s/rad'],
  about: 'Viscous damping between the body and the ground.',
  mayBeZero: true,
  first: [0.1, 1e-4],
}
const stiffness: Field = {
  key: 'stiffness',
  label: 'stiffness',
  unit: ['N/m', 'N m/rad'],
  about: 'Spring between the body and the ground.',
  mayBeZero: true,
  first: [10, 1e-2],
}

const body: Field[] = [
  mass,
  damping,
  stiffness,
  {
    key: 'coulomb',
    label: 'dry friction',
    unit: ['N', 'N m'],
    about: 'Coulomb friction of the body. Only the simulation and the relay feel it.',
    mayBeZero: true,
    first: [0.1, 1e-3],
  },
]
const link: Field[] = [
  { ...stiffness, about: 'Stiffness of the cable, belt, shaft or gear between two bodies.', mayBeZero: true, first: [1e3, 1] },
  { ...damping, about: 'Viscous damping between the two bodies.', first: [1, 1e-3] },
]
const loop: Field[] = [
  {
    key: 'sampling_period',
    label: 'sampling period',
    unit: ['s', 's'],
    about: 'Time between two samples of the controller.',
    mayBeZero: false,
    first: [1e-3, 1e-3],
  },
  {
    key: 'delay',
    label: 'delay',
    unit: ['s', 's'],
    about: 'From sample to force, in addition to the half period that holding the force costs.',
    mayBeZero: true,
    first: [1e-4, 1e-4],
  },
]
const actuator: Field[] = [
  {
    key: 'time_constant',
    label: 'lag',
    unit: ['s', 's'],
    about: 'Time constant from commanded to real force, first order.',
    mayBeZero: true,
    first: [1e-4, 1e-4],
  },
  {
    key: 'force_limit',
    label: 'largest force',
    unit: ['N', 'N m'],
    about: 'Where the force saturates. Only the simulation feels it.',
    mayBeZero: false,
    first: [10, 0.1],
    mayBeAbsent: 'none',
  },
]
const sensor: Field[] = [
  {
    key: 'resolution',
    label: 'encoder step',
    unit: ['m', 'rad'],
    about: 'Position of one count of the encoder.',
    mayBeZero: true,
    first: [1e-6, 1e-4],
  },
]
const wall: Field[] = [
  { ...stiffness, label: 'stiffness K', about: 'Stiffness of the virtual wall that is judged.', first: [1e3, 1], mayBeAbsent: 'none' },
  {
    ...damping,
    label: 'damping B',
    about: 'Virtual damper of the wall: B times the difference of two sampled positions, per period.',
    first: [1, 1e-3],
  },
  {
    key: 'velocity_filter_hz',
    label: 'velocity filter',
    unit: ['Hz', 'Hz'],
    about: 'Low-pass of the damper’s velocity; 0 is none.',
    mayBeZero: true,
    first: [100, 100],
  },
]
const filter: Field[] = [
  {
    key: 'frequency_hz',
    label: 'frequency',
    unit: ['Hz', 'Hz'],
    about: 'Where the filter of the wall’s force acts.',
    mayBeZero: false,
    first: [100, 100],
  },
  { key: 'damping_ratio', label: 'damping ratio', unit: ['', ''], about: 'Of the filter.', mayBeZero: false, first: [0.7, 0.7] },
  { key: 'depth', label: 'depth', unit: ['', ''], about: 'Gain of the notch at its frequency.', mayBeZero: false, first: [0.1, 0.1] },
  { key: 'ratio', label: 'ratio', unit: ['', ''], about: 'Of the lead or lag.', mayBeZero: false, first: [2, 2] },
]
const operator: Field[] = [
  { ...mass, about: 'Mass of the user’s hand.', mayBeZero: true },
  { ...damping, about: 'Damping of the user’s hand.', first: [1, 1e-3] },
  { ...stiffness, about: 'Stiffness of the user’s hand.', first: [100, 0.1] },
]
const driver: Field[] = [
  {
    key: 'travel',
    label: 'travel',
    unit: ['m', 'rad'],
    about: 'How far the device moves per turn behind the gear. Linear: needed; rotary: else a turn.',
    mayBeZero: false,
    first: [0.025, 6.2832],
    mayBeAbsent: 'none',
    ofRig: 'number',
  },
  {
    key: 'gear',
    label: 'gear',
    unit: ['', ''],
    about: 'Turns of the motor per turn behind the gear.',
    mayBeZero: false,
    first: [2, 2],
    mayBeAbsent: '1',
    ofRig: 'number',
  },
  {
    key: 'sign',
    label: 'sign',
    unit: ['', ''],
    about: '-1 where the drive counts against the device.',
    mayBeZero: false,
    first: [-1, -1],
    mayBeAbsent: '1',
    ofRig: 'choice',
  },
  {
    key: 'torque_constant',
    label: 'torque constant',
    unit: ['N m/A', 'N m/A'],
    about: 'Torque constant of the motor: for VESC, and SimpleFOC by current.',
    mayBeZero: false,
    first: [0.05, 0.05],
    mayBeAbsent: 'none',
    ofRig: 'number',
  },
  {
    key: 'torque_per_volt',
    label: 'torque per volt',
    unit: ['N m/V', 'N m/V'],
    about: 'Of the motor at rest, k_t/R: for SimpleFOC by voltage.',
    mayBeZero: false,
    first: [0.1, 0.1],
    mayBeAbsent: 'none',
    ofRig: 'number',
  },
  {
    key: 'id',
    label: 'id',
    unit: ['', ''],
    about: 'ODrive: the axis, 0 or 1. moteus: 1 to 127.',
    mayBeZero: false,
    first: [1, 1],
    mayBeAbsent: 'the firmware’s',
    ofRig: 'choice',
  },
  {
    key: 'command',
    label: 'command',
    unit: ['', ''],
    about: 'The motor’s letter in SimpleFOC’s Commander.',
    mayBeZero: false,
    first: [0, 0],
    mayBeAbsent: 'M',
    ofRig: 'choice',
  },
  {
    key: 'baud',
    label: 'baud',
    unit: ['', ''],
    about: 'Of the serial line.',
    mayBeZero: false,
    first: [921600, 921600],
    mayBeAbsent: 'the firmware’s',
    ofRig: 'choice',
  },
]
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
  }
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
export function groupsOf(scanned: Scan, before: Group[] = []): Group[] {
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
  const groups = [
    ...shape.bodies.map((name, i) => group(`body.${name}`, `Body “${name}”`, ['body', String(i)], body)),
    ...shape.links.map(([a, b], i) => group(`link.${i}`, `Link ${a} – ${b}`, ['link', String(i)], link)),
    group('loop', 'Loop', ['loop'], loop),
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
    key = JSON.stringify([textAt(scanned, 'name'), isRotary(scanned), shapeOf(scanned)])
    if (devices.size > 20) devices.clear()
    devices.set(toml, key)
  }
  return key
}

/** link.stiffness and link.0.stiffness are one, as are mass and inertia. */
export const fullKey = (key: string): string => key.replace(/^link\.(?=[a-z])/, 'link.0.').replace(/\.inertia$/, '.mass')
export const sameKey = (a: string, b: string): boolean => a === b || fullKey(a) === fullKey(b)

/** What the page calls a number: "Body “motor”: mass". */
export const titleOf = (group: Group, row: Row): string => `${group.title}: ${row.field.label}`

/** A text of the program with the page's names in place of the file's keys. */
export function inWords(text: string, groups: Group[]): string {
  if (!/[a-z]\.[^\s]*[a-z]/.test(text)) return text
  const names = groups.flatMap((group) => group.rows.map((row): [string, string] => [row.key, titleOf(group, row)]))
  for (const [key, name] of names.sort(([a], [b]) => b.length - a.length)) text = text.replaceAll(key, name)
  return text
}
