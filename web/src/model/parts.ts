// Bodies and links of a device, added and removed in its text. What makes no device, the server says.

import { fullKey, isRotary, sameKey, shapeOf, type Shape } from './keys'
import { append, find, removeTable, scan, set, unset } from './toml'

export type Role = 'actuated' | 'sensed' | 'held'
export const roles: [Role, string][] = [
  ['actuated', 'The motor pushes'],
  ['sensed', 'The encoder sees'],
  ['held', 'The hand holds'],
]

/** Keys of the numbers that the file says are only assumed; of such a device the program calls nothing sure. */
export const assumedKeys = (text: string): string[] => {
  const value = find(scan(text), assumedPath)?.value
  return Array.isArray(value) ? value.map(String) : []
}
const assumedPath = ['uncertainty', 'assumed']

/** The text with these keys as its assumed ones. */
function assume(text: string, keys: string[]): string {
  if (keys.length > 0) return set(text, assumedPath, `[${keys.map((key) => JSON.stringify(key)).join(', ')}]`)
  const { entries } = scan(text)
  if (!find(scan(text), assumedPath)) return text
  return entries.filter((each) => each.path[0] === 'uncertainty').length > 1
    ? set(text, assumedPath, '[]')
    : `${removeTable(text, ['uncertainty']).trimEnd()}\n`
}
const assumeMore = (text: string, keys: string[]): string => assume(text, [...assumedKeys(text), ...keys])

/** The text with that number, or all of them, said to be right. */
export function confirm(text: string, key: string | null = null): string {
  const keys = assumedKeys(text)
  const left = key === null ? [] : keys.filter((each) => !sameKey(each, key))
  return left.length === keys.length ? text : assume(text, left)
}

/** A motor that moves a handle or a wheel through a cable, belt or shaft, as a device to begin with. */
export const newLinkedDevice = (motion: 'linear' | 'rotary'): string =>
  addBody(newDevice(motion, 'motor', motion === 'rotary' ? '1e-5' : '0.1'), motion === 'rotary' ? 'wheel' : 'handle', 'motor', 'held')

/** One rigid body with an assumed mass, as a device to begin with. */
export const newDevice = (motion: 'linear' | 'rotary', name = 'body 1', mass = motion === 'rotary' ? '1e-4' : '0.1'): string =>
  assumeMore(
    `name = "new device"\n${motion === 'rotary' ? 'motion = "rotary"\n' : ''}\n[[body]]\nname = "${name}"\n${motion === 'rotary' ? `inertia = ${mass}\ndamping = 1e-4` : `mass = ${mass}\ndamping = 0.1`}\n\n[loop]\nsampling_period = 1e-3\n`,
    [`body.${name}.mass`, `body.${name}.damping`, 'loop.sampling_period'],
  )

/** The text whose damper runs with its spring, in one loop. */
export function removeDamper(text: string): string {
  const own = scan(text).entries.filter(({ path }) => path[0] === 'loop' && path[1] === 'damper')
  if (own.length === 0) return text
  const without = own.reduce((out, { path }) => unset(confirm(out, path.join('.')), path), text)
  return removeTable(without, ['loop', 'damper']).replace(/\n+$/, '\n')
}

const shape = (text: string): Shape => shapeOf(scan(text))
export const choose = (text: string, role: Role, name: string): string => set(text, ['loop', role], JSON.stringify(name))

/** A name that no body has. */
export function freeName(text: string): string {
  const { bodies } = shape(text)
  for (let i = bodies.length + 1; ; ++i) if (!bodies.includes(`body ${i}`)) return `body ${i}`
}

/** A body of an assumed mass, linked to another, for one alone is no device. Who holds what stays. */
export function addBody(text: string, name: string, to: string, as: 'free' | 'held' = 'free'): string {
  const held = as === 'held' ? name : shape(text).held
  const mass = isRotary(scan(text)) ? 'inertia = 1e-4' : 'mass = 0.1'
  const added = append(text, ['body'], `[[body]]\nname = ${JSON.stringify(name)}\n${mass}`)
  return addLink(assumeMore(held === undefined ? added : choose(added, 'held', held), [`body.${name}.mass`]), to, name)
}

export function addLink(text: string, a: string, b: string): string {
  const stiffness = isRotary(scan(text)) ? '1.0' : '1000.0'
  const { length } = shape(text).links
  const added = append(
    text,
    [length > 0 ? 'link' : 'body'],
    `[[link]]\nbetween = ${JSON.stringify([a, b])}\nstiffness = ${stiffness}\ndamping = 0.0`,
  )
  return assumeMore(added, [`link.${length}.stiffness`, `link.${length}.damping`])
}

export const connect = (text: string, link: number, a: string, b: string): string =>
  set(text, ['link', String(link), 'between'], JSON.stringify([a, b]))
/** The links behind it move up, with what is assumed of them. */
export function removeLink(text: string, link: number): string {
  const keys = assumedKeys(text).flatMap((key) => {
    const [, index, rest] = /^link\.(\d+)(\..*)$/.exec(fullKey(key)) ?? []
    return index === undefined || Number(index) < link ? [key] : Number(index) === link ? [] : [`link.${Number(index) - 1}${rest}`]
  })
  return removeTable(assume(text, keys), ['link', String(link)])
}

/** The body with its links; what pushed, saw or held it goes to the first or last body left. */
export function removeBody(text: string, name: string): string {
  const { bodies, links, ...given } = shape(text)
  const left = bodies.filter((each) => each !== name)
  let out = text
  for (const [role] of roles) {
    const next = role === 'held' ? left.at(-1) : left[0]
    if (next !== undefined) out = choose(out, role, given[role] === name ? next : (given[role] ?? next))
  }
  for (let i = links.length - 1; i >= 0; --i) if (links[i]!.includes(name)) out = removeLink(out, i)
  out = assume(
    out,
    assumedKeys(out).filter((key) => key.replace(/\.[^.]*$/, '') !== `body.${name}`),
  )
  return removeTable(out, ['body', String(bodies.indexOf(name))])
}
