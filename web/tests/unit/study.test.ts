import { describe, expect, it } from 'vitest'
import { studyLine } from '../../src/model/commands'
import { spreadsOf, studyText } from '../../src/model/study'

describe('a study', () => {
  const stiff = { key: 'link.0.stiffness', kind: 'normal-share', a: '8 %', b: '' }
  const late = { key: 'loop.delay', kind: 'uniform', a: '0', b: '0.1 ms' }

  it('is the text that the program reads', () => {
    expect(studyText({ spreads: [stiff, late], stiffness: '6 kN/m', anyUser: '3000' })).toBe(
      '[specification]\ncritical_stiffness = "6 kN/m"\nany_user = 3000\n' +
        '[[parameter]]\nkey = "link.0.stiffness"\ndistribution = "normal"\nrelative_deviation = 0.08\n' +
        '[[parameter]]\nkey = "loop.delay"\ndistribution = "uniform"\nlower = 0\nupper = "0.1 ms"\n',
    )
    expect(studyText({ spreads: [{ key: 'a.b', kind: 'device', a: '', b: '' }] })).toBe(
      '[[parameter]]\nkey = "a.b"\ndistribution = "device"\n',
    )
  })

  it('is none while nothing varies, or by nothing yet', () => {
    expect(studyText({ spreads: [] })).toBeNull()
    expect(studyText({ spreads: [stiff, { ...late, b: ' ' }] })).toBeNull()
  })

  it('comes from a link, however that was changed', () => {
    expect(spreadsOf(JSON.stringify([stiff, late]))).toEqual([stiff, late])
    for (const text of [undefined, '', '{', '3', 'null', '[null, 3, {"key": 1}]', '[{"key":"a","kind":"none such","a":"","b":""}]'])
      expect(spreadsOf(text)).toEqual([])
  })

  it('is a command with its file before it', () => {
    const line = studyLine('[[parameter]]\n', { samples: '100' })
    expect(
      line.startsWith(
        "cat > study.toml <<'END_OF_DEVICE'\n[[parameter]]\nEND_OF_DEVICE\nzwidth study - --study study.toml --samples 100 <<",
      ),
    ).toBe(true)
  })
})
