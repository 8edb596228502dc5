// A mechanism in the text of a device file: its own file's text, its tip and the normal of the wall. What of it is wrong the server says.

import { tomlOfNumber } from './decimal'
import { find, scan, set, tomlOfLines, unset } from './toml'

export type Vector = [x: number, y: number, z: number]

/** Names that the tip may have in a file: sites and bodies of MJCF, links of URDF, each once. */
export function tipsOf(text: string): string[] {
  const names = (element: string): string[] =>
    [...text.matchAll(new RegExp(`<${element}\\b[^>]*?\\bname\\s*=\\s*(?:"([^"]*)"|'([^']*)')`, 'g'))].map(
      (each) => each[1] ?? each[2] ?? '',
    )
  const all = /<robot\b/.test(text) ? names('link') : [...names('site'), ...names('body')]
  return [...new Set(all)].filter((name) => name !== '')
}

/** What stands first in a file is at its base, a robot's tip is what comes last; a site stands where somebody wanted it. */
export const likelyTip = (text: string): string | undefined => (/<robot\b/.test(text) ? tipsOf(text).at(-1) : tipsOf(text)[0])

/** The device with that text in place of the file that it named, or of the text before. */
export function withMechanismText(toml: string, text: string): string {
  return set(unset(toml, ['mechanism', 'file']), ['mechanism', 'text'], tomlOfLines(text))
}

/** A device of a mechanism's file alone: what it needs besides is assumed, and said to be. The wall begins in
 * every direction, for along one alone the tip may not move where the file has it. */
export function deviceOfMechanism(name: string, text: string): string {
  const tip = likelyTip(text)
  return `name = ${JSON.stringify(name)}

[mechanism]
${tip === undefined ? '' : `tip = ${JSON.stringify(tip)}\n`}normal = "all"
text = ${tomlOfLines(text)}

[loop]
sampling_period = 1e-3

[uncertainty]
assumed = ["loop.sampling_period"]
`
}

/** A unit vector's numbers to four places. */
export const tomlOfNormal = (normal: Vector): string =>
  `[${normal.map((each) => tomlOfNumber(Math.round(each * 1e4) / 1e4 + 0)).join(', ')}]`

export const withNormal = (toml: string, normal: string): string => set(toml, ['mechanism', 'normal'], normal)

/** The device with these positions of joints, rad or m. */
export const withPose = (toml: string, pose: Record<string, number>): string =>
  Object.entries(pose).reduce(
    (text, [joint, position]) => set(text, ['mechanism', 'pose', joint], tomlOfNumber(Number(position.toPrecision(6)))),
    toml,
  )

export const hasMechanism = (toml: string): boolean => find(scan(toml), ['mechanism', 'tip']) !== undefined
/** A file that the device names, which only its user has. */
export const fileOf = (toml: string): string => {
  const value = find(scan(toml), ['mechanism', 'file'])?.value
  return typeof value === 'string' ? value : ''
}
