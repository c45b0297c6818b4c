// Writes mjcf_table.hpp: what MuJoCo 3.3.8 makes of models that Debian's 2.2.2 does not read.
//
//   npm install mujoco-js                  (somewhere outside this tree: it is MuJoCo 3.3.8 for node)
//   NODE_PATH=<there>/node_modules DELASSUS_MODELS=<models> node tests/adapters/mujoco_table.mjs
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const require = createRequire(import.meta.url);
const load = (await import(pathToFileURL(require.resolve('mujoco-js')))).default;
const mujoco = await load();
const folder = `${process.env.DELASSUS_MODELS}/mjcf/mujoco`;

mujoco.FS.mkdir('/m');
mujoco.FS.mkdir('/m/model');
mujoco.FS.mkdir('/m/humanoid');
mujoco.FS.writeFile('/m/humanoid/humanoid.xml', readFileSync(`${folder}/humanoid.xml`, 'utf8'));

// Attributes that came after 3.3.8 and do not change a mass.
const newer = / (sleep_tolerance|sleep|surfacevel|intensity)="[^"]*"/g;

function compiled(text) {
  mujoco.FS.writeFile('/m/model/x.xml', text);
  return mujoco.MjModel.loadFromXML('/m/model/x.xml');
}

// R diag(I) Rᵀ of the unit quaternion w x y z: xx yy zz xy xz yz.
function inertia(I, q) {
  const [w, x, y, z] = q;
  const R = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]];
  const entry = (i, j) => [0, 1, 2].reduce((sum, k) => sum + R[i][k] * I[k] * R[j][k], 0);
  return [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]].map(([i, j]) => entry(i, j));
}

function rows(m, withSizes = false) {
  const kinds = [0, 0, 0, 0];
  for (const kind of m.jnt_type) ++kinds[kind];
  const lines = [`counts ${m.nbody - 1} ${kinds.join(' ')} ${m.ngeom} ${m.nsite} ${m.ntendon} ${m.nu}`];
  for (let b = 1; b < m.nbody; ++b) {
    const at = (array, n) => Array.from(array).slice(n * b, n * b + n);
    lines.push(['body', m.body_parentid[b] - 1, m.body_mass[b], ...at(m.body_ipos, 3),
      ...inertia(at(m.body_inertia, 3), at(m.body_iquat, 4))].join(' '));
  }
  for (let g = 0; withSizes && g < m.ngeom; ++g)
    lines.push(['size', ...Array.from(m.geom_size).slice(3 * g, 3 * g + 3)].join(' '));
  return lines;
}

const body = (geom, assets = '') =>
  `<mujoco>${assets}<worldbody><body><freejoint/>${geom}</body></worldbody></mujoco>`;
const texts = [];
for (const shape of ["size='.3'", "type='capsule' size='.2 .3'", "type='cylinder' size='.2 .3'", "type='box' size='.1 .2 .3'",
  "type='ellipsoid' size='.1 .2 .3'"])
  texts.push(body(`<geom shellinertia='true' density='7' euler='10 20 30' ${shape}/>`));
const wedge = "vertex='0 0 0 2 0 0 2 3 0 0 3 0 0 0 1 2 0 1'";
const faces = " face='0 2 1 0 3 2 0 1 5 0 5 4 3 4 2 2 4 5 1 2 5 0 4 3'";
for (const mesh of [wedge, wedge + faces, `${wedge} scale='2 -1 .5'`, `${wedge}${faces} inertia='exact'`,
  `${wedge}${faces} inertia='shell'`, `${wedge} refpos='1 2 3' refquat='1 0 0 1'`])
  for (const geom of ["type='mesh' mesh='m' pos='1 2 3' euler='10 20 30'", "type='mesh' mesh='m' mass='3'"])
    texts.push(body(`<geom ${geom}/>`, `<asset><mesh name='m' ${mesh}/></asset>`));
for (const type of ['sphere', 'capsule', 'cylinder', 'ellipsoid', 'box'])
  for (const fit of ['', "<compiler fitaabb='true'/>"])
    texts.push(body(`<geom type='${type}' mesh='m' fitscale='1.5'/>`, `${fit}<asset><mesh name='m' ${wedge}${faces}/></asset>`));
for (const builtin of ["'sphere' params='2'", "'hemisphere' params='3'", "'cone' params='5 .5'", "'supersphere' params='8 .5 .7'",
  "'supertorus' params='12 .3 .8 1'"])
  texts.push(body("<geom type='mesh' mesh='m'/>", `<asset><mesh name='m' scale='1 1.5 2' builtin=${builtin}/></asset>`));
texts.push("<mujoco><compiler eulerseq='zYx'/><worldbody><replicate count='12' offset='.1 .2 .3' euler='1 20 3'><body name='b' pos='1 0 " +
  "0'><joint/><geom type='box' size='.1 .2 .3'/><geom size='.1' pos='1 1 0'/></body></replicate></worldbody></mujoco>");

const lines = [];
for (const name of ['car', 'carousel', 'dominos', 'newton_cradle', 'treadmill'])
  try {
    lines.push(`model mujoco/${name}`, ...rows(compiled(readFileSync(`${folder}/${name}.xml`, 'utf8').replace(newer, ''))));
  } catch (error) {
    if (lines.at(-1) === `model mujoco/${name}`) lines.pop();
    console.log(`${name} is not read: ${error}`);
  }
for (const text of texts) lines.push(`text ${text}`, ...rows(compiled(text), true));

// A string of more than 64 kB is more than some compilers take.
const pieces = [];
for (let at = 0; at < lines.length; at += 100) pieces.push(`R"(${lines.slice(at, at + 100).join('\n')}\n)"`);
writeFileSync(new URL('mjcf_table.hpp', import.meta.url), `/// Written by mujoco_table.mjs, out of MuJoCo ${mujoco.mj_versionString()}.
#pragma once

inline constexpr const char* mujoco_table[] = {
${pieces.join(',\n')}};
`);
console.log(`${lines.length} lines`);
