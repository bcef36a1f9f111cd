// Acrobots with a motor and sensors, in WebAssembly. instruments.d.ts describes the interface.

import { Batch as Ideal, checkIndex } from "./batch.js";
import { readDraws } from "./environment.js";
import { call, empty, fields, orFree, pack, unpack } from "./kept.js";
import { STRUCTS } from "./layout.js";
import { randomSeed } from "./wasm.js";

const { acrobot_instruments_t: INSTRUMENTS } = STRUCTS;

export { moduleBytes, setModule } from "./wasm.js";

export class Batch extends Ideal {
  constructor(options) {
    const { instruments, instrumentDraws, ...ideal } = Object(options);
    super(Object(options) === options ? ideal : options);
    orFree(this, () => {
      if (instruments !== undefined) this.setInstruments(instruments);
      if (instrumentDraws !== undefined) this.setInstrumentDraws(instrumentDraws);
      this.reset(ideal.seed ?? randomSeed());
    });
  }

  instrumentsOf(index) {
    checkIndex(this, index);
    const words = empty(INSTRUMENTS);
    call({}, "acrobot_batch_instruments", this, index, words);
    return unpack(words, INSTRUMENTS);
  }

  setInstrumentsOf(index, instruments) {
    checkIndex(this, index);
    this.#set("acrobot_batch_set_instruments", instruments, index);
  }

  setInstruments(instruments) {
    this.#set("acrobot_batch_set_all_instruments", instruments);
  }

  #set(name, instruments, ...index) {
    const given = fields("instruments", instruments, INSTRUMENTS);
    call(given, name, this, ...index, pack(empty(INSTRUMENTS), given, INSTRUMENTS));
  }

  setInstrumentDraws(draws) {
    const { given, words } = readDraws(draws, "instrumentDraws", INSTRUMENTS);
    call(given, "acrobot_batch_set_instrument_draws", this, words);
  }
}
