// Makes loops end: calls of `$loop` in the head of each `while` and `for`.

/** What may have the name of a loop in it, the names, and what heads consist of. */
const TOKENS = new RegExp([
  /\/\/.*|\/\*[^]*?\*\//, /'(?:\\.|[^'\\\n])*'|"(?:\\.|[^"\\\n])*"|`(?:\\[^]|[^\\`])*`/,
  /[\w$.]+/, /[()[\]{};]/,
].map(({ source }) => source).join("|"), "g");

/** The code with calls, and lines as before. */
export function watched(code) {
  /** The open heads: the depth of brackets in it, and the number of semicolons. */
  const heads = [];
  let loop = null;
  let written = 0;
  let [result, line] = ["", 1];
  const insert = (at, text) => {
    result += code.slice(written, at) + text;
    written = at;
  };
  for (const { 0: token, index } of code.matchAll(TOKENS)) {
    const [head] = heads;
    if (/^(while|for)$/.test(token)) {
      line = code.slice(0, index).split("\n").length;
      loop = token;
    } else if (loop !== null && token === "(") {
      if (loop === "while") insert(index + 1, `$loop(${line}),`);
      heads.unshift({ depth: 0, semicolons: loop === "for" ? 0 : NaN, line });
      loop = null;
    } else if ("([{".includes(token) && head) head.depth++;
    else if (")]}".includes(token) && head && head.depth-- === 0) heads.shift();
    else if (token === ";" && head?.depth === 0 && ++head.semicolons === 2) {
      const isEmpty = /^\s*\)/.test(code.slice(index + 1));
      insert(index + 1, `$loop(${head.line})${isEmpty ? "" : ","}`);
    }
  }
  return result + code.slice(written);
}
