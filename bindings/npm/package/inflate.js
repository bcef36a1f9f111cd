// Decompresses DEFLATE data (RFC 1951). Browsers do this only asynchronously, and a constructor cannot wait.

/** The order in which a block has the lengths of the codes for lengths. */
const ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/** Decompresses valid data that has only blocks with dynamic codes. The result has `length` bytes. */
export function inflate(data, length) {
  const out = new Uint8Array(length);
  let written = 0;
  let position = 0;

  const bits = (count) => {
    let value = 0;
    for (let i = 0; i < count; i++, position++) value |= ((data[position >> 3] >> (position & 7)) & 1) << i;
    return value;
  };

  /** A canonical Huffman code: for each length of codes their count, and all symbols in the order of their codes. */
  const code = (lengths) => {
    const symbols = [...lengths.keys()].filter((symbol) => lengths[symbol] > 0);
    const counts = Array.from({ length: 16 }, (_, length) => symbols.filter((symbol) => lengths[symbol] === length).length);
    return { counts, symbols: symbols.sort((a, b) => lengths[a] - lengths[b] || a - b) };
  };

  const symbol = ({ counts, symbols }) => {
    let rank = 0; // of the first code of this length among all codes
    let offset = 0; // of the bits read so far from the first code of their length
    for (let length = 1; ; length++) {
      offset = 2 * offset + bits(1);
      if (offset < counts[length]) return symbols[rank + offset];
      rank += counts[length];
      offset -= counts[length];
    }
  };

  /** A number of which `step` codes at a time have one more extra bit, beginning after the first two times `step` codes. */
  const number = (code, step, first) => {
    const extra = Math.max(Math.floor(code / step) - 1, 0);
    const base = extra === 0 ? code : (step + (code % step)) << extra;
    return first + base + bits(extra);
  };

  for (let last = 0; !last; ) {
    last = bits(1);
    if (bits(2) !== 2) throw new Error("a block must have dynamic codes");
    const [literals, distances, given] = [bits(5) + 257, bits(5) + 1, bits(4) + 4];
    const order = new Array(19).fill(0);
    for (const symbol of ORDER.slice(0, given)) order[symbol] = bits(3);
    const lengthCode = code(order);
    const lengths = [];
    while (lengths.length < literals + distances) {
      const length = symbol(lengthCode);
      if (length < 16) lengths.push(length);
      else if (length === 16) lengths.push(...new Array(3 + bits(2)).fill(lengths.at(-1)));
      else lengths.push(...new Array(length === 17 ? 3 + bits(3) : 11 + bits(7)).fill(0));
    }
    const [literal, distance] = [code(lengths.slice(0, literals)), code(lengths.slice(literals))];
    for (let value = symbol(literal); value !== 256; value = symbol(literal)) {
      if (value < 256) {
        out[written++] = value;
        continue;
      }
      let count = value === 285 ? 258 : number(value - 257, 4, 3);
      for (const from = number(symbol(distance), 2, 1); count > 0; count--, written++) out[written] = out[written - from];
    }
  }
  return out;
}
