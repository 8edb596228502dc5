import { expect, it } from 'vitest'
import { askedUnit } from '../../src/model/asked_units'

it('asks about a stiffness where a torque belongs, and the other way round', () => {
  expect(askedUnit('5 N m/rad', 'N m')?.instead).toEqual(['5 N m'])
  expect(askedUnit('0.4 mN m / deg', 'N m')?.instead).toEqual(['0.4 mN m'])
  expect(askedUnit('3 N m', 'N m/rad')?.instead).toEqual(['3 N m/rad', '3 N m/deg'])
  expect(askedUnit('3 mN m', 'N m/rad')?.isPerAngle).toBe(false)
})
it('asks nothing else', () => {
  for (const [typed, unit] of [
    ['5 N m', 'N m'],
    ['5', 'N m'],
    ['5 N m/rad', 'N m/rad'],
    ['0.4 N m/deg', 'N m/rad'],
    ['5 N/m', 'N/m'],
    ['5 N', 'N'],
    ['5 N m s/rad', 'N m s/rad'],
    ['5 s', 'N m/rad'],
    ['5 kg', 'N m'],
    ['rubbish', 'N m'],
  ] as const)
    expect(askedUnit(typed, unit), typed).toBeNull()
})
