// What stood in the way of people who were new to it.
import { expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { nobody, documentOf, openPage, place, project, row, runPalette, settled, show, type, withWall } from './program'

const here = place('devices/lhifam.toml')
const focused = '[data-key]:has(input[type="text"]:focus)'

it('goes by Tab from number to number, and by keys through each', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const text = (key: string) => row(page, key).locator('input[type="text"]')
  await text('body.motor.mass').focus()
  await page.keyboard.press('Tab')
  await expect.poll(() => page.locator(focused).getAttribute('data-key')).toBe('body.motor.damping')
  await page.keyboard.press('Shift+Tab')
  await expect.poll(() => page.locator(focused).getAttribute('data-key')).toBe('body.motor.mass')
  // The slider's ends: a thousand times and a hundredth of the decade that the number is in.
  await page.keyboard.press('Control+End')
  await expect.poll(() => text('body.motor.mass').inputValue()).toBe('100 kg')
  await page.keyboard.press('Control+Home')
  await expect.poll(() => text('body.motor.mass').inputValue()).toBe('1 kg')
  // What Tab passes by has its name.
  await runPalette(page, 'lock body motor mass')
  await expect.poll(() => text('body.motor.mass').isDisabled()).toBe(true)
  await runPalette(page, 'free body motor mass')
  await expect.poll(() => text('body.motor.mass').isDisabled()).toBe(false)
  await runPalette(page, 'follow loop delay')
  await expect.poll(() => page.getByLabel('Number', { exact: true }).inputValue()).toBe('loop.delay')
  await page.keyboard.press('?')
  await page.getByRole('dialog', { name: 'Commands' }).waitFor()
  expect(complaints).toEqual([])
  await context.close()
})

it('puts a wall that no user destabilises, with the keyboard on it', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'Time')
  await page.locator('#panel-time').getByRole('button', { name: 'put one at the limit' }).click()
  await page.waitForSelector('[data-answer="wall"]')
  await page.waitForFunction(() => document.activeElement?.matches('#panel-bar .handle'))
  await settled(page)
  await expect.poll(() => row(page, 'wall.stiffness').locator('input[type="text"]').inputValue()).toBe('5.7 kN/m') // of 5.776
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toMatch(/^✓/)
  // Emptied, the number is gone, and the wall with it.
  await type(page, 'wall.stiffness', '')
  await settled(page)
  await expect.poll(() => page.locator('[data-answer="wall"]').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('shows where a number with a unit of its own is in a sweep', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'loop.delay', '1 ms')
  await runPalette(page, 'follow loop delay')
  await page.locator('#body-sweep', { hasText: 'Now: 1 ms' }).waitFor()
  await settled(page)
  await expect.poll(() => page.locator('#body-sweep svg .vertical').count()).toBe(1)
  expect(complaints).toEqual([])
  await context.close()
})

it('says why a relay has no reading in the program’s words, and shows what it is to be compared with', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'open example capstan')
  await runPalette(page, 'show: relay')
  await page.getByLabel(/Force of the relay/).fill('1e-4')
  await page.keyboard.press('Enter')
  const relay = documentOf('relay', 'devices/capstan_paddle.toml', '--amplitude', '1e-4') as {
    trust: { reasons: string[] }
    predictions: { crossovers: unknown[] }
  }
  const panel = page.locator('#body-relay')
  await panel.locator('.refused', { hasText: relay.trust.reasons[0]! }).waitFor()
  await expect.poll(() => panel.locator('tbody tr').count()).toBe(relay.predictions.crossovers.length)
  await expect.poll(() => panel.innerText()).not.toContain('read by the relay')
  expect(complaints).toEqual([])
  await context.close()
})

it('names what reaches a stiffness, folds away what does not, and says when it is reached', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'Change')
  const wanted = page.getByLabel(/Limit wanted/)
  await settled(page)
  await expect.poll(() => wanted.getAttribute('placeholder')).toBe('such as 18 kN/m') // twice the limit there is
  await wanted.fill('12 kN/m')
  await wanted.press('Enter')
  await settled(page)
  const { targets } = documentOf('design', 'devices/lhifam.toml', '--target', '12 kN/m') as { targets: { value_needed: number | null }[] }
  const table = page.getByRole('region', { name: 'What reaches the stiffness' })
  await expect.poll(() => table.locator('tbody tr').count()).toBe(targets.filter((each) => each.value_needed !== null).length)
  await expect.poll(() => table.evaluate((each) => each.scrollWidth - each.clientWidth)).toBeLessThanOrEqual(0)
  await page.getByText(`Numbers that alone cannot (${targets.filter((each) => each.value_needed === null).length})`).click()
  await page.getByRole('button', { name: 'Use: Body “handle”: damping' }).click()
  await page.locator('#body-limits', { hasText: 'The limit is 12 kN/m now.' }).waitFor()
  expect(complaints).toEqual([])
  await context.close()
})

it('fits a record with dry friction in time, and one of two bodies with the handle held', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/free_motion.csv`)
  await page.locator('#column-time').selectOption('time')
  await page.getByLabel('Fit', { exact: true }).selectOption('rigid')
  await page.getByLabel('By', { exact: true }).selectOption('time-domain')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByText(/^What else explains the record \(/).click()
  await page.locator('#body-recording table', { hasText: 'coulomb friction (friction.body)' }).waitFor()
  const inTime = documentOf(
    'identify',
    'recordings/free_motion.csv',
    '--force',
    'force',
    '--position',
    'position',
    '--time',
    'time',
    '--method',
    'time-domain',
    '--structure',
    'rigid',
    '--motion',
    'linear',
  ) as { critical_stiffness: number }
  await settled(page)
  await expect
    .poll(() => page.locator('#body-recording').innerText())
    .toContain(`The device fitted: critical stiffness ${Number((inTime.critical_stiffness / 1000).toPrecision(4))} kN/m`)
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByLabel('By', { exact: true }).selectOption('frequency-response')
  await page.getByLabel('Fit', { exact: true }).selectOption('two-body')
  await page.getByLabel('handle', { exact: true }).check()
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  const held = documentOf(
    'identify',
    'recordings/locked_chirp.csv',
    '--force',
    'force',
    '--position',
    'position',
    '--structure',
    'two-body',
    '--method',
    'frequency-response',
    '--locked',
    'handle',
  ) as { critical_stiffness: number }
  await expect
    .poll(() => page.locator('#body-recording').innerText())
    .toContain(`The device fitted: critical stiffness ${Number((held.critical_stiffness / 1000).toPrecision(4))} kN/m`)
  await page.getByRole('button', { name: 'Use this device' }).click()
  await settled(page)
  await expect.poll(() => page.locator('[data-answer="example"]').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('keeps answer, bar and wall in view on every tab, however far down one works, and with a user the limit with nobody', async () => {
  for (const width of [1440, 1024, 390]) {
    const { page, context, complaints } = await openPage(here, width)
    const inView = (selector: string): Promise<boolean> =>
      page.locator(selector).evaluate((each) => {
        const box = each.getBoundingClientRect()
        const on = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2)
        return box.top >= 0 && box.bottom <= innerHeight && (each.contains(on) || on?.contains(each) === true)
      })
    await withWall(page)
    for (const tab of await page.getByRole('tab').allInnerTexts()) {
      await show(page, tab)
      await settled(page)
      await page.evaluate(() => document.querySelectorAll('.device, .sheets').forEach((each) => each.scrollTo({ top: 1e6 })))
      for (const part of ['[data-answer="nobody"]', '[data-answer="any-user"]', '[data-answer="trust"]', '#panel-bar .handle .knob.fill'])
        expect(await inView(part), `${part} on ${tab}, ${width} pixels wide`).toBe(true)
    }
    // The limit to build on stands first.
    await expect.poll(() => page.locator('.limits dt').first().innerText()).toBe('Any passive user')
    await type(page, 'wall.stiffness', '')
    await type(page, 'loop.delay', '0.25 ms')
    await settled(page)
    const delayed = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.delay=0.25 ms') as { critical_stiffness: number }
    await expect.poll(() => nobody(page)).toBe(`${(delayed.critical_stiffness / 1000).toPrecision(4)} kN/m`)
    await type(page, 'loop.delay', '0')
    await expect.poll(() => page.locator('[data-answer="user"]').count()).toBe(0)
    await runPalette(page, 'go to user who holds it damping')
    await type(page, 'operator.damping', '10')
    await page.locator('[data-answer="nobody"]', { hasText: '8.849 kN/m' }).waitFor()
    const held = documentOf('analyze', 'devices/lhifam.toml', '--set', 'operator.damping=10') as { critical_stiffness: number }
    await settled(page)
    await expect
      .poll(() => page.locator('[data-answer="user"]').innerText())
      .toBe(`${Number((held.critical_stiffness / 1000).toPrecision(4))} kN/m`)
    expect(complaints).toEqual([])
    await context.close()
  }
})

it('fits one rigid body by inverse dynamics', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/free_motion.csv`)
  await page.getByLabel('By', { exact: true }).selectOption('inverse-dynamics')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  const found = documentOf(
    'identify',
    'recordings/free_motion.csv',
    '--force',
    'force',
    '--position',
    'position',
    '--method',
    'inverse-dynamics',
  ) as { parameters: { value: number; unit: string }[] }
  const shown = await page.locator('#body-recording').innerText()
  for (const each of found.parameters) expect(shown).toContain(say(each.value, each.unit))
  expect(shown).toContain('trust: sound')
  // The device, without its friction, over what was measured: 1/(m w^2) where it moves as a mass.
  await page.locator('#body-recording .legend', { hasText: 'fitted, without dry friction' }).first().waitFor()
  await settled(page)
  await page.getByRole('button', { name: 'Table of Response, magnitude' }).click()
  const drawn = (
    await page.locator('#body-recording .table-scroll tbody tr').filter({ hasText: 'fitted' }).last().locator('td').allInnerTexts()
  )
    .slice(1)
    .map(Number)
  expect(drawn[1]).toBeCloseTo(-20 * Math.log10(found.parameters[0]!.value * (2 * Math.PI * drawn[0]!) ** 2), 0)
  await page.getByRole('button', { name: 'Use this device' }).click()
  await settled(page)
  await expect
    .poll(() => row(page, 'body.body.coulomb').locator('input[type="text"]').inputValue())
    .toBe(say(found.parameters[2]!.value, 'N'))
  expect(complaints).toEqual([])
  await context.close()
})

it('asks of a device fitted with a body held for that body’s numbers, until they are given', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByLabel('handle', { exact: true }).check()
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).click()
  const assumed = page.locator('[data-answer="assumed"]')
  await assumed.waitFor()
  await expect.poll(() => assumed.innerText()).toContain('Body “handle”: mass, damping.')
  await type(page, 'body.handle.mass', '5.1')
  await type(page, 'body.handle.damping', '3.4')
  await assumed.waitFor({ state: 'detached' })
  // What only its sum showed: of a new device what is known is typed and locked, the rest fitted.
  await runPalette(page, 'new motor and handle, linear')
  for (const [key, value] of [
    ['body.motor.damping', '0.1'],
    ['body.handle.mass', '5.1'],
    ['body.handle.damping', '3.4'],
    ['loop.sampling_period', '1 ms'],
  ] as const)
    await type(page, key, value)
  for (const key of ['body.motor damping', 'body.handle mass', 'body.handle damping'])
    await page.getByRole('button', { name: `Lock ${key}`, exact: true }).click()
  await page.getByLabel('Fit', { exact: true }).selectOption('device')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.locator('#body-recording', { hasText: /trust: sound[^]*trust: sound/ }).waitFor()
  await page.getByRole('button', { name: 'Use this device' }).click()
  await page.locator('[data-answer="trust"]', { hasText: 'sound' }).waitFor()
  expect(parseFloat(await nobody(page))).toBeCloseTo(8.849, 1)
  expect(complaints).toEqual([])
  await context.close()
})

it('types over what stands in a field, however one came there, and takes it back with Escape', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await page.getByRole('button', { name: /^Body motor/ }).focus()
  await page.keyboard.press('Enter')
  const mass = row(page, 'body.motor.mass').locator('input[type="text"]')
  await expect.poll(() => mass.evaluate((each) => document.activeElement === each)).toBe(true)
  await page.keyboard.type('0.4')
  await page.keyboard.press('Escape')
  await expect.poll(() => mass.inputValue()).toBe('0.3 kg')
  await row(page, 'body.motor.damping').locator('input[type="text"]').click()
  await page.keyboard.type('0.2')
  await page.keyboard.press('Enter')
  await settled(page)
  await expect.poll(() => row(page, 'body.motor.damping').locator('input[type="text"]').inputValue()).toBe('0.2 N s/m')
  await expect.poll(() => mass.inputValue()).toBe('0.3 kg')
  expect(complaints).toEqual([])
  await context.close()
})

it('takes what the program says to write instead of a frequency and of counts', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'loop.sampling_period', '2 kHz')
  await page.getByRole('button', { name: 'Take 0.5 ms' }).click()
  await runPalette(page, 'go to encoder step')
  await page.keyboard.type('200 counts/mm')
  await page.keyboard.press('Enter')
  await page.getByRole('button', { name: 'Take 1 mm/200' }).click()
  await settled(page)
  const found = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.sampling_period=0.5 ms') as { critical_stiffness: number }
  await expect.poll(() => nobody(page)).toBe(say(found.critical_stiffness, 'N/m'))
  await expect.poll(() => row(page, 'sensor.resolution').locator('input[type="text"]').inputValue()).toBe('1 mm/200')
  expect(complaints).toEqual([])
  await context.close()
})

it('goes on with the first number of a new device, and the palette goes to a number before it locks it', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'new motor and wheel, rotary')
  const inertia = row(page, 'body.motor.mass').locator('input[type="text"]')
  await expect.poll(() => inertia.evaluate((each) => document.activeElement === each)).toBe(true)
  await page.keyboard.type('1.2e-4')
  await runPalette(page, 'wheel inertia')
  await page.keyboard.type('22 kg cm2')
  await page.keyboard.press('Enter')
  await settled(page)
  await expect.poll(() => page.locator('[data-answer="assumed"]').innerText()).toContain('Body “motor”: damping; Link motor – wheel')
  await runPalette(page, 'they are right')
  await page.locator('[data-answer="assumed"]').waitFor({ state: 'detached' })
  await expect.poll(() => page.locator('[data-answer="trust"]').innerText()).toContain('sound')
  expect(complaints).toEqual([])
  await context.close()
})
