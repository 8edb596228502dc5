// The program's own server and a browser, for the tests.

import { type ChildProcess, execFileSync, spawn } from 'node:child_process'
import { dirname, resolve } from 'node:path'
import { fileURLToPath } from 'node:url'
import { type Browser, type BrowserContext, chromium, type Page } from 'playwright-core'
import { afterAll, beforeAll } from 'vitest'
import { chromiumHere } from '../chromium.mjs'

export const project = resolve(dirname(fileURLToPath(import.meta.url)), '../../..')
export const program = resolve(process.env.ZWIDTH ?? `${project}/build/release/bin/zwidth`)

export interface Served {
  address: string
  stop: () => Promise<void>
}

/** `zwidth serve` on a free port; it must have the page built in. */
export const serve = (...files: string[]): Promise<Served> => serveAt(0, ...files)
export async function serveAt(port: number, ...files: string[]): Promise<Served> {
  const child: ChildProcess = spawn(program, ['serve', ...files, '--port', String(port)], {
    cwd: project,
    stdio: ['ignore', 'pipe', 'inherit'],
  })
  const address = await new Promise<string>((done, failed) => {
    let text = ''
    child.stdout!.on('data', (data: Buffer) => {
      text += data.toString()
      const found = /http:\/\/\S+/.exec(text)
      if (found) done(found[0])
    })
    child.on('exit', (code) => failed(new Error(`zwidth serve ended with ${code}`)))
  })
  return {
    address,
    stop: () =>
      new Promise((done) => {
        child.removeAllListeners('exit')
        child.on('exit', () => done())
        child.kill('SIGINT')
      }),
  }
}

export const openBrowser = (): Promise<Browser> => chromium.launch(chromiumHere())

/** A server with these devices and a browser, for all tests of a file. */
export interface Place {
  served: Served
  browser: Browser
}
export function place(...files: string[]): Place {
  const here = {} as Place
  beforeAll(async () => {
    here.served = await serve(...files)
    here.browser = await openBrowser()
  })
  afterAll(async () => {
    await here.browser?.close()
    await here.served?.stop()
  })
  return here
}

export interface Opened {
  page: Page
  context: BrowserContext
  complaints: string[] // errors of the console, requests that went elsewhere
}

export async function openPage({ browser, served }: Place, width: number, hash = '', scheme: 'light' | 'dark' = 'light'): Promise<Opened> {
  const context = await browser.newContext({
    viewport: { width, height: 900 },
    colorScheme: scheme,
    reducedMotion: 'reduce',
    acceptDownloads: true,
  })
  await context.grantPermissions(['clipboard-read', 'clipboard-write'])
  const page = await context.newPage()
  page.setDefaultTimeout(90_000)
  const complaints: string[] = []
  page.on('pageerror', (error) => complaints.push(error.message))
  page.on('console', (message) => {
    // A refused input is answered with status 400, which the browser logs.
    if (['error', 'warning'].includes(message.type()) && !/status of 400/.test(message.text())) complaints.push(message.text())
  })
  page.on('request', (request) => {
    const url = request.url()
    if (!url.startsWith(served.address.replace(/\/$/, '')) && !/^(data|blob):/.test(url)) complaints.push(`asked for ${url}`)
  })
  // When the first answer is painted: in the frame after the one in which it is there.
  await page.addInitScript(() => {
    const look = (): unknown =>
      document.querySelector('[data-answer="nobody"]')
        ? requestAnimationFrame(() => performance.mark('first answer'))
        : requestAnimationFrame(look)
    look()
  })
  await page.goto(served.address + hash)
  await page.waitForSelector('[data-answer="nobody"]')
  return { page, context, complaints }
}

/**
 * All panels have caught up: none is busy, twice in a row. By the page's own clock and frames, after which what it was to do
 * before is done (a panel that came into view has asked), however slow the machine is.
 */
export async function settled(page: Page): Promise<void> {
  const restsOnce = (): Promise<boolean> =>
    page.evaluate(async () => {
      const frame = (): Promise<unknown> => new Promise((done) => requestAnimationFrame(done))
      await frame().then(frame)
      await new Promise((done) => setTimeout(done, 50))
      return !document.querySelector('[aria-busy="true"]')
    })
  const until = Date.now() + 90_000
  for (let rests = 0; rests < 2; ) {
    if (Date.now() > until) throw new Error('panels stay busy')
    rests = (await restsOnce()) ? rests + 1 : 0
  }
}

/** The address is written behind a change; by the page's own clock, which comes after what it was to do before. */
export const addressOf = async (page: Page): Promise<string> => {
  await page.evaluate(() => new Promise((done) => setTimeout(done, 300)))
  return new URL(page.url()).hash
}

export const documentOf = (...words: string[]): Record<string, unknown> =>
  JSON.parse(execFileSync(program, [...words, '--json'], { cwd: project, encoding: 'utf8' })) as Record<string, unknown>

export const runPalette = async (page: Page, text: string): Promise<void> => {
  await page.keyboard.press('Control+k')
  await page.getByRole('combobox', { name: 'What to do?' }).waitFor()
  await page.keyboard.type(text)
  await page.keyboard.press('Enter')
}

export const row = (page: Page, key: string) => page.locator(`[data-key="${key}"]`)
export const nobody = (page: Page): Promise<string> => page.locator('[data-answer="nobody"]').innerText()

/** A tab of the page; of a narrow one the device is one, too. */
export const show = async (page: Page, tab: string): Promise<void> => page.getByRole('tab', { name: tab, exact: true }).click()
export const tabs = ['Wall', 'Time', 'Frequency', 'Change', 'Recording', 'Compare', 'Study', 'File']
/** Each tab in turn, once its panels have caught up. */
export async function onEachTab(page: Page, look: (tab: string) => Promise<void>): Promise<void> {
  for (const tab of tabs) {
    await show(page, tab)
    await settled(page)
    await look(tab)
  }
}
/** Device and numbers, which on a wide page always stand there. */
export async function toDevice(page: Page): Promise<void> {
  if ((await page.getByRole('tab', { name: 'Device', exact: true }).count()) > 0) await show(page, 'Device')
}
export const withWall = async (page: Page): Promise<void> => {
  await toDevice(page)
  await page.getByRole('button', { name: /Put a wall/ }).click()
  await page.waitForSelector('[data-answer="wall"]')
}
export const type = async (page: Page, key: string, text: string): Promise<void> => {
  await toDevice(page)
  const input = row(page, key).locator('input[type="text"]')
  await input.fill(text)
  await input.press('Enter')
}
/** Every panel with a question; the tab that was shown at first is shown again. */
const questions = [
  ['Change', /Limit wanted/, '12 kN/m'],
  ['Time', /It oscillates at/, '41'],
  ['Frequency', /Force of the relay/, '5'],
] as const
export const askAll = async (page: Page, of: readonly (typeof questions)[number][0][] = ['Change', 'Time', 'Frequency']): Promise<void> => {
  for (const [tab, label, text] of questions.filter(([each]) => of.includes(each))) {
    await show(page, tab)
    await page.getByLabel(label).fill(text)
    await page.getByLabel(label).press('Enter')
  }
  await show(page, 'Wall')
}
