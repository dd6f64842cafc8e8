// node run_firmware.mjs MODULES FIRMWARE STAND_IN SCRIPT: runs FIRMWARE/main.py as it is, under
// MicroPython, with the modules of STAND_IN in place of the robot's. Prints a line of speeds and of
// what was said for each turn of SCRIPT, then how it ended.
import {readFileSync, readdirSync, statSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, firmware, standIn, script] = process.argv.slice(2);
const micropython =
    resolve(modules, 'node_modules/@micropython/micropython-webassembly-pyscript/micropython.mjs');
const {loadMicroPython} = await import(pathToFileURL(micropython));
const lines = [];
const mp = await loadMicroPython({heapsize: 16 << 20, linebuffer: true, stdout: (line) => lines.push(line)});

function copy(from, to) {
  for (const name of readdirSync(from)) {
    if (name === '__pycache__') continue;
    const path = join(from, name);
    if (statSync(path).isDirectory()) {
      mp.FS.mkdir(`${to}/${name}`);
      copy(path, `${to}/${name}`);
    } else {
      mp.FS.writeFile(`${to}/${name}`, readFileSync(path));
    }
  }
}
mp.FS.mkdir('/robot');
copy(standIn, '/robot');
copy(firmware, '/robot');
mp.FS.writeFile('/script', readFileSync(script));
mp.runPython(`
import sys
sys.path.insert(0, '/robot')
import bench
import _time_stand_in as stand_in
sys.modules['time'] = stand_in
bench.load(open('/script').read())
try:
    import main
    end = 'returned'
except bench.Over:
    end = 'over'
except Exception as error:
    end = 'failed ' + repr(error)
for line in bench.trace:
    print(line)
print('end', end)
print('speeds', *bench.speeds)
print('off', bench.motors_off)
print('told', bench.motors_told)
print('screen', '|'.join(bench.screen))
print('uart', *bench.uart)
`);
process.stdout.write(lines.join('\n') + '\n');
