// Copies, proxies and freed objects throw errors that say so.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { inspect } from "node:util";

import { Acrobot, Batch } from "../dist/index.js";
import { Learner, Perceptron } from "../dist/policies.js";

const POLICY = readFileSync(new URL("../../../crates/policy/policy.bin", import.meta.url));
/** An object of each class, and what saves it. */
const objects = () => [
  [new Acrobot(), "snapshot()"],
  [new Batch({ count: 2 }), "snapshot()"],
  [new Learner(), "save()"],
  [new Perceptron(POLICY), "the file it was made of"],
];

/** Calls of all methods, getters and setters of an object, without arguments. */
function usesOf(object) {
  const uses = [];
  for (let of = object; (of = Object.getPrototypeOf(of)) !== Object.prototype; ) {
    const { constructor, ...own } = Object.getOwnPropertyDescriptors(of);
    for (const [name, { get, set, value }] of Object.entries(own)) {
      for (const use of [get, set, value]) if (use) uses.push([name, (it) => use.call(it)]);
    }
  }
  return uses;
}

test("JSON and structuredClone, which would give {}, throw an error that names what saves", () => {
  for (const [i, [object, by]] of objects().entries()) {
    const { name } = object.constructor;
    const message = `${name} must be saved by ${by}, not by JSON or structuredClone`;
    assert.throws(() => JSON.stringify({ object }), { name: "TypeError", message });
    assert.throws(() => structuredClone([object]), { name: "DataCloneError", message: /toJSON/ });
    assert.deepEqual(object, objects()[i][0]);
  }
});

test("methods of proxies and copies, and without an object, throw an error with the class", () => {
  for (const [object] of objects()) {
    const { name, prototype } = object.constructor;
    const itself = "must be called on the object itself, not on a proxy or a copy, got ";
    const message = new RegExp(`^methods of (Acrobot and )?${name}( and Batch)? ${itself}`);
    const uses = usesOf(object);
    assert.ok(uses.length > 0);
    // valtio makes a proxy of a copy.
    const copy = Object.assign(Object.create(prototype), object);
    for (const wrong of [new Proxy(object, {}), copy, new Proxy(copy, {}), undefined, {}]) {
      for (const [use, call] of uses) {
        assert.throws(() => call(wrong), { name: "TypeError", message }, `${name}.${use}`);
      }
    }
    assert.equal(Object.prototype.toString.call(copy), `[object ${name}]`);
  }
  assert.equal(inspect([new Proxy(new Acrobot(), {})]), "[ Acrobot proxy or copy ]");
});

test("after free, every use throws that error before it reads arguments", () => {
  for (const [kind, freed] of [["acrobot", new Acrobot()], ["batch", new Batch({ count: 2 })]]) {
    freed.free();
    const uses = usesOf(freed).filter(([name]) => name !== "free");
    assert.ok(uses.length > 15);
    for (const [name, call] of uses) {
      const message = `the ${kind} has been freed`;
      assert.throws(() => call(freed), { name: "Error", message }, name);
    }
  }
});
