// What the name of a recording's column says of its unit: "torque [mNm]", "angle (counts)".

const units: Record<string, string> = {
  Nm: 'N m',
  mNm: 'mN m',
  uNm: 'uN m',
  Nmm: 'N mm',
  Ncm: 'N cm',
  N: 'N',
  mN: 'mN',
  m: 'm',
  cm: 'cm',
  mm: 'mm',
  um: 'um',
  rad: 'rad',
  mrad: 'mrad',
  deg: 'deg',
  '°': 'deg',
  turn: 'turn',
  turns: 'turn',
  rev: 'turn',
}
const inBrackets = (name: string): string =>
  (/[[(]\s*([^\])]+?)\s*[\])]\s*$/.exec(name)?.[1] ?? '').replace(/[µμ]/g, 'u').replace(/[.*· ]/g, '')

/** As the program writes one of it; empty where there is none, or it is the SI unit itself. */
export function unitIn(name: string): string {
  const unit = units[inBrackets(name)]
  return unit === undefined || /^(N|m|rad|N m)$/.test(unit) ? '' : `1 ${unit}`
}

/** Whether it counts: what one count is only its user knows. */
export const countsIn = (name: string): boolean => /^(count|tick|step|lsb|inc|increment|pulse|digit)s?$/i.test(inBrackets(name))
