import { describe, expect, it } from 'vitest'
import { percent, say, sayAlike, shifted, shown, tomlOfNumber, tomlOfTyped, wholeRatio, written } from '../../src/model/decimal'

describe('decimal', () => {
  it('moves the point without rounding', () => {
    expect(shifted('0.1', 3)).toBe('100')
    expect(shifted('123.456', -3)).toBe('0.123456')
    expect(shifted('5e-324', 324)).toBe('5')
    let seed = 1
    for (let i = 0; i < 2000; ++i) {
      seed = (seed * 48271) % 2147483647
      const value = (seed / 2147483647 - 0.5) * 10 ** ((seed % 40) - 20)
      for (const unit of ['N/m', 's', 'kg', 'Hz']) {
        const text = shown(value, unit)
        expect(Number(tomlOfTyped(`${text.number} ${text.unit}`, text)), `${value} ${unit}`).toBe(value)
      }
    }
  })

  it('says numbers side by side in one unit, as long as the least is read well', () => {
    const alike = sayAlike([12_000, 950, null, Infinity], 'N/m')
    expect([12_000, 950, null].map((each) => alike(each))).toEqual(['12 kN/m', '0.95 kN/m', 'none'])
    expect(sayAlike([3e8, 20], 'N/m')(20)).toBe('20 N/m')
    expect(sayAlike([], 'N/m')(5)).toBe('5 N/m')
    expect(sayAlike([0, 2], 'N m/rad')(0)).toBe('0 N m/rad')
  })

  it('says numbers with prefixes', () => {
    expect(say(8848.70869, 'N/m')).toBe('8.849 kN/m')
    expect(say(0.001, 's')).toBe('1 ms')
    expect(say(0, 's')).toBe('0 s')
    expect(say(0.005, 'kg m²')).toBe('0.005 kg m²')
    expect(say(3.14e-6, 'm')).toBe('3.14 µm')
    expect(say(null, 'N/m')).toBe('none')
    expect(say(1.089e-28, 'N/m')).toBe('1.089e-28 N/m') // not "1.089e-19 nN/m"
    expect(say(2e-12, 's')).toBe('0.002 ns')
    expect(say(99995, 'N/m')).toBe('100 kN/m')
    expect(percent(0.000406)).toBe('+0.041 %')
    expect(percent(-0.1338)).toBe('−13.4 %')
    expect(percent(0)).toBe('0 %')
  })

  it('takes a bare number as SI, whatever stood there', () => {
    const kilo = shown(79500, 'N/m')
    expect(kilo).toEqual({ number: '79.5', unit: 'kN/m', places: 3 })
    expect(tomlOfTyped('79500', kilo)).toBe('79500')
    expect(tomlOfTyped(' 2 ', { unit: 'ms', places: -3 })).toBe('2')
    expect(tomlOfTyped('4096', shown(1e-6, 'rad'))).toBe('4096')
    expect(tomlOfTyped('−4')).toBe('-4')
    expect(tomlOfTyped('+1.50e3')).toBe('1500')
  })

  it('takes a text with its own unit', () => {
    expect(tomlOfTyped('80 kN/m', shown(79500, 'N/m'))).toBe('80000')
    expect(tomlOfTyped('80 N/m', shown(79500, 'N/m'))).toBe('"80 N/m"')
    expect(tomlOfTyped('0.08 MN/m', shown(79500, 'N/m'))).toBe('"0.08 MN/m"')
    expect(tomlOfTyped(' 1.5 ms', shown(0.002, 's'))).toBe('0.0015')
    expect(tomlOfTyped(' 1.5 ms')).toBe('"1.5 ms"')
    expect(tomlOfTyped('4096 counts', shown(1e-6, 'rad'))).toBe('"4096 counts"')
    expect(tomlOfTyped('5 s', shown(0.002, 's'))).toBe('"5 s"')
    expect(tomlOfTyped('5 ms', shown(2, 's'))).toBe('"5 ms"')
    expect(tomlOfTyped('abc')).toBe('"abc"')
  })

  it('reads and writes the values of a file', () => {
    expect(written('1.5 ms')).toEqual({ number: 1.5, unit: 'ms' })
    expect(written('1 turn/4096')).toEqual({ number: 1, unit: 'turn/4096' })
    expect(written(0.3)).toEqual({ number: 0.3, unit: null })
    expect(written('0,01')).toBeNull() // a comma is no unit
    expect(tomlOfNumber(1e21)).toBe('1e21')
  })

  it('goes from period to period that fit', () => {
    expect(wholeRatio(1.3e-4, 1e-3)).toBe(1.25e-4)
    expect(wholeRatio(2.4e-3, 1e-3)).toBe(2e-3)
    expect(wholeRatio(1.01e-4, 1e-3, 1e-4)).toBe(1.11111111111e-4)
    expect(wholeRatio(0.99e-4, 1e-3, 1e-4)).toBe(9.09090909091e-5)
    expect(wholeRatio(1.01e-3, 1e-3, 1e-3)).toBe(2e-3)
    expect(wholeRatio(1e-9, 1e-3)).toBe(1e-6)
  })
})
