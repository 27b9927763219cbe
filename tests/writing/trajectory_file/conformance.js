// SPDX-License-Identifier: LGPL-2.1-or-later
//
//     node conformance.js MODULES DESCRIPTION FILE...
//
// Compiles a Kaitai description with the packages in MODULES and reads files with the parser that comes out. Prints a
// line for each header and record, as plain_text.py does, but for the last digits of real numbers.
'use strict';
const fs = require('fs');
const path = require('path');
const [modules, description, ...files] = process.argv.slice(2);
const load = (name) => require(path.resolve(modules, name));
const compiler = load('kaitai-struct-compiler');
const KaitaiStream = load('kaitai-struct/KaitaiStream');
const layout = load('js-yaml').load(fs.readFileSync(description, 'utf8'));

const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

function words(record, type) {
  return layout.types[type].seq.flatMap(({ id, type: kind }) => {
    const value = record[camel(id)];
    if (kind === 'table') return words(value, kind).map((word, i) => (i % 2 ? word : `${id}.${word}`));
    if (kind === 'string') return [id, Buffer.from(value.value, 'utf8').toString('hex')];
    if (value instanceof Uint8Array) return [id, Buffer.from(value).toString('hex')];
    return [id, ...(Array.isArray(value) ? value : [value]).map((one) => (Number.isNaN(one) ? 'nan' : `${one}`))];
  });
}

function parser(code) {
  const module = { exports: {} };
  new Function('module', 'exports', 'require', code)(module, module.exports, () => KaitaiStream);
  return module.exports.Pkmt || module.exports;
}

async function main() {
  const made = await compiler.compile('javascript', layout, null, false);
  const Pkmt = parser(made['Pkmt.js']);
  for (const file of files) {
    const bytes = fs.readFileSync(file);
    const read = new Pkmt(new KaitaiStream(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)));
    console.log(['header', ...words(read.header, 'header')].join(' '));
    for (const [table, { type }] of Object.entries(layout.instances)) {
      for (const record of read[table]) console.log([table, ...words(record, type)].join(' '));
    }
  }
}

main().catch((fault) => {
  console.error(`${fault}`);
  process.exit(1);
});
