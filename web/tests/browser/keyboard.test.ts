// The work of a session by keyboard nobody, and what is heard.
import type { Locator, Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { nobody, documentOf, openPage, place, project, runPalette, settled, show, type } from './program'

const here = place()

/** Tab until it has the focus. */
async function tabTo(page: Page, target: Locator): Promise<void> {
  await target.waitFor()
  for (let i = 0; i < 150; ++i) {
    if (await target.evaluate((element) => element === document.activeElement)) return
    await page.keyboard.press('Tab')
  }
  throw new Error('150 tabs do not reach it')
}

it.each([1280, 390])('says what limits my wheel and what wall to run, at %d px', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  const started = Date.now()
  await runPalette(page, 'open example quanser')
  await page.waitForFunction(() => /quanser/i.test(document.title))
  await runPalette(page, 'go to body servo inertia')
  await page.waitForFunction(() => document.activeElement?.matches('[data-key="body.servo.mass"] input'))
  await page.keyboard.type('22 kg cm^2')
  await page.keyboard.press('Enter')
  await settled(page)
  const set = ['devices/quanser_torsion.toml', '--set', 'body.servo.mass=22 kg cm^2']
  const answer = documentOf('analyze', ...set) as { critical_stiffness: number; limited_by: { kind: string; mode?: number } }
  await expect.poll(() => nobody(page)).toBe(say(answer.critical_stiffness, 'N m/rad'))
  await expect
    .poll(() => page.locator('[data-answer="limited-by"]').innerText())
    .toContain(answer.limited_by.kind === 'rigid_body' ? 'the rigid body' : `vibration mode ${answer.limited_by.mode}`)
  await runPalette(page, 'which wall')
  await tabTo(page, page.getByRole('button', { name: 'Use this wall: recommended' }))
  await page.keyboard.press('Enter')
  await settled(page)
  const wall = (documentOf('design', ...set, '--recommend') as { wall: { stiffness: number } }).wall
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toMatch(/is stable/)
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toContain(say(wall.stiffness, 'N m/rad'))
  console.log(`by keyboard at ${width} px: ${((Date.now() - started) / 1000).toFixed(1)} s`)
  expect(complaints).toEqual([])
  await context.close()
})

it('makes a device of a recording', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  // Asked for well before: a busy browser takes its time to hand the choice over instead of showing its own window.
  const chooser = page.waitForEvent('filechooser')
  await runPalette(page, 'show: from a recording')
  await tabTo(page, page.getByLabel(/choose it/))
  await page.keyboard.press('Space')
  await (await chooser).setFiles(`${project}/recordings/locked_chirp.csv`)
  await tabTo(page, page.getByLabel('Fit'))
  await page.keyboard.type('the device')
  await tabTo(page, page.getByLabel('handle', { exact: true }))
  await page.keyboard.press('Space')
  await tabTo(page, page.getByRole('button', { name: 'Fit', exact: true }))
  await page.keyboard.press('Enter')
  const use = page.getByRole('button', { name: 'Use this device' })
  await use.waitFor()
  await settled(page)
  await tabTo(page, use)
  await page.keyboard.press('Enter')
  await page.locator('[data-answer="nobody-interval"]').waitFor()
  const fitted = documentOf(
    'identify',
    'recordings/locked_chirp.csv',
    '--force',
    'force',
    '--position',
    'position',
    '--structure',
    'devices/lhifam.toml',
    '--locked',
    'handle',
  )
  await expect.poll(() => nobody(page)).toBe(say(Number(fitted.critical_stiffness), 'N/m'))
  expect(complaints).toEqual([])
  await context.close()
})

it('sounds as the oscillation swings', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'wall.stiffness', '8.8 kN/m')
  await settled(page)
  await show(page, 'Time')
  await settled(page)
  // What is played is kept, and rendered by an OfflineAudioContext.
  await page.evaluate(() => {
    class Silent extends OfflineAudioContext {
      constructor() {
        super(1, 1, 44100)
      }
      override createBufferSource(): AudioBufferSourceNode {
        const source = super.createBufferSource()
        source.start = () => Object.assign(window, { played: source.buffer })
        return source
      }
    }
    Object.assign(window, { AudioContext: Silent })
  })
  await page.getByRole('button', { name: 'Listen' }).click()
  const factor = Number(/(\d+) times faster/.exec(await page.locator('#body-time').innerText())?.[1] ?? 1)
  const heard = await page.evaluate(async () => {
    const { played } = window as unknown as { played: AudioBuffer }
    const offline = new OfflineAudioContext(1, played.length, played.sampleRate)
    const source = offline.createBufferSource()
    source.buffer = played
    source.connect(offline.destination)
    source.start()
    const samples = (await offline.startRendering()).getChannelData(0)
    let best = { hertz: 0, size: 0 }
    for (let hertz = 50; hertz < 1000; hertz += 0.25) {
      let [re, im] = [0, 0]
      for (let i = 0; i < samples.length; i += 8) {
        const angle = (2 * Math.PI * hertz * i) / played.sampleRate
        re += samples[i]! * Math.cos(angle)
        im += samples[i]! * Math.sin(angle)
      }
      const size = Math.hypot(re, im)
      if (size > best.size) best = { hertz, size }
    }
    return best.hertz
  })
  const { oscillation } = documentOf('simulate', 'devices/lhifam.toml', '--set', 'wall.stiffness=8800') as {
    oscillation: { frequency_hz: number }
  }
  console.log(`heard ${heard} Hz, ${factor} times the oscillation's ${oscillation.frequency_hz} Hz`)
  expect(Math.abs(heard / factor / oscillation.frequency_hz - 1)).toBeLessThan(0.02)
  expect(complaints).toEqual([])
  await context.close()
})

it('goes from a new device straight to its numbers', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await tabTo(page, page.getByRole('button', { name: 'New, open' }))
  await page.keyboard.press('Enter')
  await tabTo(page, page.getByRole('button', { name: 'New motor and wheel, rotary' }))
  await page.keyboard.press('Enter')
  const first = page.locator('[data-key="body.motor.mass"] input[type="text"]')
  await expect.poll(() => first.evaluate((element) => element === document.activeElement)).toBe(true)
  await settled(page)
  await expect.poll(() => page.evaluate(() => document.documentElement.scrollHeight - innerHeight)).toBeLessThanOrEqual(0) // the answer stays in view
  expect(complaints).toEqual([])
  await context.close()
})
