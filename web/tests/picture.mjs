// Draws docs/workbench.png and docs/workbench_recording.png: the page as the program shows it. usage: node tests/picture.mjs [PROGRAM]
import { spawn } from 'node:child_process'
import { dirname, resolve } from 'node:path'
import { fileURLToPath } from 'node:url'
import { chromium } from 'playwright-core'
import { chromiumHere } from './chromium.mjs'

const project = resolve(dirname(fileURLToPath(import.meta.url)), '../..')
const program = resolve(process.argv[2] ?? `${project}/build/release/bin/zwidth`)
const server = spawn(program, ['serve', 'devices/lhifam.toml', '--set', 'wall.stiffness=3000', '--set', 'wall.damping=10', '--port', '0'], {
  cwd: project,
  stdio: ['ignore', 'pipe', 'inherit'],
})
const address = await new Promise((done) => server.stdout.once('data', (data) => done(String(data).trim())))
const browser = await chromium.launch(chromiumHere())
const page = await browser.newPage({ viewport: { width: 1280, height: 860 }, colorScheme: 'light', reducedMotion: 'reduce' })
await page.goto(address)
await page.waitForSelector('[data-answer="wall"]')
const settled = async () => {
  await page.waitForTimeout(500)
  await page.waitForFunction(() => document.querySelectorAll('[aria-busy="true"]').length === 0)
}
await settled()
await page.screenshot({ path: `${project}/docs/workbench.png` })
for (const known of ['body.motor damping', 'body.handle mass', 'body.handle damping'])
  await page.getByRole('button', { name: `Lock ${known}`, exact: true }).click()
await page.getByRole('tab', { name: 'Recording', exact: true }).click()
await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
await page.getByLabel('Fit', { exact: true }).selectOption('device')
await page.getByLabel('handle', { exact: true }).check()
await page.getByRole('button', { name: 'Fit', exact: true }).click()
await page.getByRole('button', { name: 'Use this device' }).waitFor()
await settled()
await page.setViewportSize({ width: 1280, height: 6000 }) // the whole panel in view: nothing moves while it is drawn
await settled()
await page.locator('#panel-recording').screenshot({ path: `${project}/docs/workbench_recording.png` })
await browser.close()
server.kill('SIGINT')
