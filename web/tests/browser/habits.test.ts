// What stood in the way of people who were new to it.
import { expect, it } from 'vitest'
import { documentOf, openPage, place, project, row, runPalette, settled, type } from './program'

const here = place('devices/lhifam.toml')
const focused = '[data-key]:has(input[type="text"]:focus)'

it('goes by Tab from number to number, and by keys through each', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const text = (key: string) => row(page, key).locator('input[type="text"]')
  await text('body.motor.mass').focus()
  await page.keyboard.press('Tab')
  expect(await page.locator(focused).getAttribute('data-key')).toBe('body.motor.damping')
  await page.keyboard.press('Shift+Tab')
  expect(await page.locator(focused).getAttribute('data-key')).toBe('body.motor.mass')
  // The slider's ends: a thousand times and a hundredth of the decade that the number is in.
  await page.keyboard.press('Control+End')
  expect(await text('body.motor.mass').inputValue()).toBe('100 kg')
  await page.keyboard.press('Control+Home')
  expect(await text('body.motor.mass').inputValue()).toBe('1 kg')
  // What Tab passes by has its name.
  await runPalette(page, 'lock body motor mass')
  expect(await text('body.motor.mass').isDisabled()).toBe(true)
  await runPalette(page, 'free body motor mass')
  expect(await text('body.motor.mass').isDisabled()).toBe(false)
  await runPalette(page, 'follow loop delay')
  expect(await page.getByLabel('Number', { exact: true }).inputValue()).toBe('loop.delay')
  await page.keyboard.press('?')
  await page.getByRole('dialog', { name: 'Commands' }).waitFor()
  expect(complaints).toEqual([])
  await context.close()
})

it('puts a wall that no user destabilises, with the keyboard on it', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await page.locator('#panel-time').getByRole('button', { name: 'put one at the limit' }).click()
  await page.waitForSelector('[data-answer="wall"]')
  await page.waitForFunction(() => document.activeElement?.matches('#panel-bar .handle'))
  await settled(page)
  expect(await row(page, 'wall.stiffness').locator('input[type="text"]').inputValue()).toBe('5.7 kN/m') // of 5.776
  expect(await page.locator('[data-answer="wall"]').innerText()).toMatch(/^✓/)
  // Emptied, the number is gone, and the wall with it.
  await type(page, 'wall.stiffness', '')
  await settled(page)
  expect(await page.locator('[data-answer="wall"]').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('shows where a number with a unit of its own is in a sweep', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'loop.delay', '1 ms')
  await runPalette(page, 'follow loop delay')
  await page.locator('#body-sweep', { hasText: 'Now: 1 ms' }).waitFor()
  await settled(page)
  expect(await page.locator('#body-sweep svg .vertical').count()).toBe(1)
  expect(complaints).toEqual([])
  await context.close()
})

it('says why a relay has no reading in the program’s words, and shows what it is to be compared with', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'open example capstan')
  await runPalette(page, 'show: relay')
  await page.getByLabel(/Force of the relay/).fill('1e-4')
  await page.keyboard.press('Enter')
  const relay = documentOf('relay', 'devices/capstan_paddle.toml', '--amplitude', '1e-4') as { trust: { reasons: string[] }; predictions: { crossovers: unknown[] } }
  const panel = page.locator('#body-relay')
  await panel.locator('.refused', { hasText: relay.trust.reasons[0]! }).waitFor()
  expect(await panel.locator('tbody tr').count()).toBe(relay.predictions.crossovers.length)
  expect(await panel.innerText()).not.toContain('read by the relay')
  expect(complaints).toEqual([])
  await context.close()
})

it('names what reaches a stiffness, folds away what does not, and says when it is reached', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const wanted = page.getByLabel(/Limit wanted/)
  await settled(page)
  expect(await wanted.getAttribute('placeholder')).toBe('such as 18 kN/m') // twice the limit there is
  await wanted.fill('12 kN/m')
  await wanted.press('Enter')
  await settled(page)
  const { targets } = documentOf('design', 'devices/lhifam.toml', '--target', '12 kN/m') as { targets: { value_needed: number | null }[] }
  const table = page.getByRole('region', { name: 'What reaches the stiffness' })
  expect(await table.locator('tbody tr').count()).toBe(targets.filter((each) => each.value_needed !== null).length)
  expect(await table.evaluate((each) => each.scrollWidth - each.clientWidth)).toBeLessThanOrEqual(0)
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
  await page.getByLabel('Time', { exact: true }).selectOption('time')
  await page.getByLabel('Fit', { exact: true }).selectOption('rigid')
  await page.getByLabel('By', { exact: true }).selectOption('time-domain')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.locator('#body-recording', { hasText: 'Body “body”: dry friction' }).waitFor({ timeout: 60_000 })
  const inTime = documentOf('identify', 'recordings/free_motion.csv', '--force', 'force', '--position', 'position', '--time', 'time', '--method', 'time-domain', '--structure', 'rigid', '--motion', 'linear') as { critical_stiffness: number }
  await settled(page)
  expect(await page.locator('#body-recording').innerText()).toContain(`The device fitted: critical stiffness ${(inTime.critical_stiffness / 1000).toPrecision(4)} kN/m`)
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByLabel('By', { exact: true }).selectOption('frequency-response')
  await page.getByLabel('Fit', { exact: true }).selectOption('two-body')
  await page.getByLabel('handle', { exact: true }).check()
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  const held = documentOf('identify', 'recordings/locked_chirp.csv', '--force', 'force', '--position', 'position', '--structure', 'two-body', '--locked', 'handle') as { critical_stiffness: number }
  expect(await page.locator('#body-recording').innerText()).toContain(`The device fitted: critical stiffness ${(held.critical_stiffness / 1000).toPrecision(4)} kN/m`)
  await page.getByRole('button', { name: 'Use this device' }).click()
  await settled(page)
  expect(await page.locator('[data-answer="example"]').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('shows the limits while one works further down, and with a user the limit that there is with nobody', async () => {
  for (const width of [1280, 390]) {
    const { page, context, complaints } = await openPage(here, width)
    const short = page.locator('[data-answer="in-short"]')
    expect(await short.count()).toBe(0)
    await row(page, 'loop.delay').scrollIntoViewIfNeeded()
    await page.evaluate(() => document.querySelector('[data-key="loop.delay"]')!.scrollIntoView({ block: 'start' }))
    await short.waitFor()
    expect(await short.innerText()).toMatch(/alone 8\.849 kN\/m, any user 5\.776 kN\/m/)
    await type(page, 'loop.delay', '0.25 ms')
    await settled(page)
    const delayed = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.delay=0.25 ms') as { critical_stiffness: number }
    expect(await short.innerText()).toContain(`alone ${(delayed.critical_stiffness / 1000).toPrecision(4)} kN/m`)
    await type(page, 'loop.delay', '0')
    expect(await page.locator('[data-answer="nobody"]').count()).toBe(0)
    await runPalette(page, 'go to user who holds it damping')
    await type(page, 'operator.damping', '10')
    await page.locator('[data-answer="nobody"]', { hasText: '8.849 kN/m' }).waitFor()
    const held = documentOf('analyze', 'devices/lhifam.toml', '--set', 'operator.damping=10') as { critical_stiffness: number }
    await settled(page)
    expect(await page.locator('[data-answer="alone"]').innerText()).toBe(`${(held.critical_stiffness / 1000).toPrecision(4)} kN/m`)
    expect(complaints).toEqual([])
    await context.close()
  }
})
