// Bodies and links of a device, added and removed in its text. What makes no device, the server says.

import { isRotary, shapeOf, type Shape } from './keys'
import { append, removeTable, scan, set, samePath, type Entry } from './toml'

export type Role = 'actuated' | 'sensed' | 'held'
export const roles: [Role, string][] = [
  ['actuated', 'The motor pushes'],
  ['sensed', 'The encoder sees'],
  ['held', 'The hand holds'],
]

/** Stands behind a number that nobody has measured: it goes when the number is changed, or is said to be right. */
const firstValue = '# a first value'

/** The numbers of the text that are still first ones, with their marks. */
function markedEntries(text: string): { entry: Entry; end: number }[] {
  const { entries, comments } = scan(text)
  return comments.flatMap(({ start, end }) => {
    const entry = entries.findLast((each) => each.end <= start)
    return entry && text.slice(start, end).trim() === firstValue && text.slice(entry.end, start).trim() === '' && !text.slice(entry.end, start).includes('\n') ? [{ entry, end }] : []
  })
}
export const firstValues = (text: string): string[][] => markedEntries(text).map(({ entry }) => entry.path)

/** The text without the mark of that number, or of all of them. */
export function confirm(text: string, path: string[] | null = null): string {
  let out = text
  for (const { entry, end } of markedEntries(text).reverse()) {
    if (path === null || samePath(entry.path, path)) out = out.slice(0, entry.end) + out.slice(end)
  }
  return out
}

/** A motor that moves a handle or a wheel through a cable, belt or shaft, as a device to begin with. */
export const newLinkedDevice = (motion: 'linear' | 'rotary'): string =>
  motion === 'rotary'
    ? addBody(newDevice(motion).replace('"body 1"', '"motor"').replace('inertia = 1e-4', 'inertia = 1e-5'), 'wheel', 'motor', 'held')
    : addBody(newDevice(motion).replace('"body 1"', '"motor"'), 'handle', 'motor', 'held')

/** One rigid body with a first mass, as a device to begin with. */
export const newDevice = (motion: 'linear' | 'rotary'): string =>
  `name = "new device"\n${motion === 'rotary' ? 'motion = "rotary"\n' : ''}\n[[body]]\nname = "body 1"\n${motion === 'rotary' ? `inertia = 1e-4 ${firstValue}\ndamping = 1e-4` : `mass = 0.1 ${firstValue}\ndamping = 0.1`} ${firstValue}\n\n[loop]\nsampling_period = 1e-3 ${firstValue}\n`

const shape = (text: string): Shape => shapeOf(scan(text))
export const choose = (text: string, role: Role, name: string): string => set(text, ['loop', role], JSON.stringify(name))

/** A name that no body has. */
export function freeName(text: string): string {
  const { bodies } = shape(text)
  for (let i = bodies.length + 1; ; ++i) if (!bodies.includes(`body ${i}`)) return `body ${i}`
}

/** A body of a first mass, linked to another, for one alone is no device. Who holds what stays. */
export function addBody(text: string, name: string, to: string, as: 'free' | 'held' = 'free'): string {
  const held = as === 'held' ? name : shape(text).held
  const mass = isRotary(scan(text)) ? 'inertia = 1e-4' : 'mass = 0.1'
  const added = append(text, ['body'], `[[body]]\nname = ${JSON.stringify(name)}\n${mass} ${firstValue}`)
  return addLink(held === undefined ? added : choose(added, 'held', held), to, name)
}

export function addLink(text: string, a: string, b: string): string {
  const stiffness = isRotary(scan(text)) ? '1.0' : '1000.0'
  return append(text, [shape(text).links.length > 0 ? 'link' : 'body'], `[[link]]\nbetween = ${JSON.stringify([a, b])}\nstiffness = ${stiffness} ${firstValue}\ndamping = 0.0 ${firstValue}`)
}

export const connect = (text: string, link: number, a: string, b: string): string => set(text, ['link', String(link), 'between'], JSON.stringify([a, b]))
export const removeLink = (text: string, link: number): string => removeTable(text, ['link', String(link)])

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
  return removeTable(out, ['body', String(bodies.indexOf(name))])
}
