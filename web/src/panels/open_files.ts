// Files that are opened or dropped: a device, a mechanism's file, or a device with its mechanism's file.
import { deviceOfMechanism, fileOf, withMechanismText } from '../model/mechanism'
import { workbench } from '../model/workbench.svelte'
import { notice, showAnswer } from './open.svelte'

const isDevice = ({ name }: File): boolean => /\.toml$/i.test(name)
export const isMechanism = ({ name }: File): boolean => /\.(xml|urdf|mjcf)$/i.test(name)
/** Whether they are opened here; else they are recordings. */
export const areDevices = (files: File[]): boolean => files.some((each) => isDevice(each) || isMechanism(each))

const baseName = (path: string): string => path.split(/[\\/]/).at(-1) ?? ''

/** As text; what is none, as a recording or a picture with another name, is refused. */
async function textOf(file: File): Promise<string> {
  const text = new TextDecoder('utf-8', { fatal: true }).decode(await file.arrayBuffer())
  if (text.includes('\0')) throw new TypeError('it holds a zero byte')
  return text
}

/** A mechanism's file goes into the device that waits for it; where none does it is a device to begin with. */
export async function openFiles(files: File[]): Promise<void> {
  const texts = new Map<File, string>()
  for (const file of files) {
    try {
      texts.set(file, await textOf(file))
    } catch {
      notice.text = `${file.name} is no text: a device file is TOML, a mechanism MJCF or URDF, in UTF-8. Nothing was opened.`
      return
    }
  }
  notice.text = ''
  const device = files.find(isDevice)
  const mechanisms = files.filter(isMechanism)
  const toml = device && texts.get(device)
  const named = fileOf(toml ?? workbench.toml)
  const mechanism = mechanisms.find(({ name }) => name === baseName(named)) ?? mechanisms[0]
  const text = (mechanism && texts.get(mechanism)) ?? null
  if (toml !== undefined) {
    workbench.load(text !== null && named !== '' ? withMechanismText(toml, text) : toml)
  } else if (mechanism && text !== null) {
    if (named !== '') workbench.change({ toml: withMechanismText(workbench.toml, text) })
    else workbench.load(deviceOfMechanism(mechanism.name.replace(/\.\w+$/, ''), text))
  }
  showAnswer()
}
