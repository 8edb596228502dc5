import { expect, it } from 'vitest'
import { heard, heardWord } from '../../src/panels/sound'

it('lasts at least two seconds, in a pitch that is heard, and says how', () => {
  for (const duration of [0.05, 1, 7, 60])
    for (const frequency of [0.5, 6, 41, 149, 150, 700, 2000, 9000]) {
      const plan = heard(duration, frequency)
      const pitch = frequency * plan.faster
      if (frequency > 3) expect(pitch).toBeGreaterThanOrEqual(150)
      expect(pitch).toBeLessThanOrEqual(2000)
      if (plan.times < 50) expect((plan.times * duration) / plan.faster).toBeGreaterThanOrEqual(2 - 1e-9)
      expect(heardWord(plan).includes('faster')).toBe(plan.faster > 1)
      expect(heardWord(plan).includes('slower')).toBe(plan.faster < 1)
    }
  expect(heardWord(heard(5, null))).toBe('as fast as it is')
  expect(heardWord(heard(1, 6))).toBe('32 times faster than it is, to be heard; 50 times over')
})
