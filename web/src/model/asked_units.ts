// Units that the program takes, for an angle has no dimension, though they are of another kind than the number: a stiffness in N m/rad
// where a torque belongs, and a torque where a stiffness does. Whoever types one is asked.

import { written } from './decimal'

export interface AskedUnit {
  typed: string
  isPerAngle: boolean // a stiffness was typed; else a torque
  instead: string[] // what may be meant
}

const perAngle = /\s*(\/\s*(m?rad|deg|°|turn|rev)|\s(m?rad|deg)(\^-1|-1))\s*$/

/** null: nothing to ask. `unit`: the SI unit of the number. */
export function askedUnit(typed: string, unit: string): AskedUnit | null {
  const value = written(typed)
  if (value === null || value.unit === null || !/N/.test(value.unit)) return null
  const isPerAngle = perAngle.test(value.unit)
  const text = (of: string): string => `${value.number} ${of}`
  if (unit === 'N m' && isPerAngle) return { typed: typed.trim(), isPerAngle, instead: [text(value.unit.replace(perAngle, ''))] }
  if (unit === 'N m/rad' && !isPerAngle && /m$/.test(value.unit))
    return { typed: typed.trim(), isPerAngle, instead: [text(`${value.unit}/rad`), text(`${value.unit}/deg`)] }
  return null
}
