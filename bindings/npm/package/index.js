// Gymnasium's Acrobot-v1 in WebAssembly. index.d.ts describes the interface.

export { Acrobot } from "./acrobot.js";
export { Batch } from "./batch.js";
export { moduleBytes, setModule } from "./wasm.js";
