// Files that are opened or dropped: a device, a mechanism's file, or a device with its mechanism's file.
import { deviceOfMechanism, fileOf, withMechanismText } from '../model/mechanism'
import { workbench } from '../model/workbench.svelte'
import { showAnswer } from './open.svelte'

const isDevice = ({ name }: File): boolean => /\.toml$/i.test(name)
export const isMechanism = ({ name }: File): boolean => /\.(xml|urdf|mjcf)$/i.test(name)
/** Whether they are opened here; else they are recordings. */
export const areDevices = (files: File[]): boolean => files.some((each) => isDevice(each) || isMechanism(each))

const baseName = (path: string): string => path.split(/[\\/]/).at(-1) ?? ''

/** A mechanism's file goes into the device that waits for it; where none does it is a device to begin with. */
export async function openFiles(files: File[]): Promise<void> {
  const device = files.find(isDevice)
  const mechanisms = files.filter(isMechanism)
  const named = device ? fileOf(await device.text()) : fileOf(workbench.toml)
  const mechanism = mechanisms.find(({ name }) => name === baseName(named)) ?? mechanisms[0]
  const text = (await mechanism?.text()) ?? null
  if (device) {
    const toml = await device.text()
    workbench.load(text !== null && named !== '' ? withMechanismText(toml, text) : toml)
  } else if (mechanism && text !== null) {
    if (named !== '') workbench.change({ toml: withMechanismText(workbench.toml, text) })
    else workbench.load(deviceOfMechanism(mechanism.name.replace(/\.\w+$/, ''), text))
  }
  showAnswer()
}
