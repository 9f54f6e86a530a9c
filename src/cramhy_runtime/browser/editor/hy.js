// Hy for CodeMirror: what is coloured, and how a line is indented. Brackets are of three kinds, strings have prefixes or bracket marks.

const SPECIAL = new Set(
  `and as-> assert await break chainc cond continue cut defclass defmacro defmain defn defreader del do do-mac doto else eval-and-compile
   eval-when-compile except finally fn for get global if import in is lfor dfor gfor sfor let match nonlocal not or pragma py pys quasiquote
   quote raise require return setv setx try unless unpack-iterable unpack-mapping unquote unquote-splice when while with yield
   yield-from`.split(/\s+/),
);
const ATOMS = new Set(["True", "False", "None", "Inf", "NaN", "self"]);
const HAS_BODY =
  /^(?:def|with|when|unless|for|while|fn|let|do|try|except|match|eval-|[ldgs]for)|^(?:top-level|seq|par|pursue|try-all|whenever)$/;
const NUMBER = /^[+-]?(?:0[xob][\da-fA-F_]+|\d[\d_,]*(?:\.\d*)?(?:[eE][+-]?\d+)?j?)(?=[\s()[\]{}";']|$)/;

function token(stream, state) {
  if (state.end !== null) {
    return text(stream, state);
  }
  if (stream.eatSpace()) return null;
  const column = stream.column();
  if (stream.match(/^;.*/)) return "comment";
  if (stream.match(NUMBER)) return head(state, stream, column, "number");
  const bracket = stream.match(/^#\[([^[\]]*)\[/);
  if (bracket) {
    state.end = `]${bracket[1]}]`;
    return text(stream, state);
  }
  if (stream.match(/^[bfrt]*"/)) {
    state.end = '"';
    return text(stream, state);
  }
  if (stream.match(/^#_|^#\*\*?|^[~@'`^]+/)) return "meta";
  const next = stream.next();
  if ("([{".includes(next)) {
    head(state, stream, column, null);
    state.open.push({ column, list: next === "(", word: null, first: null, items: 0 });
    return "bracket";
  }
  if (")]}".includes(next)) {
    state.open.pop();
    return "bracket";
  }
  stream.match(/^[^\s()[\]{}";]*/);
  const word = stream.current();
  const isHead = state.open.at(-1)?.list && state.open.at(-1).items === 0;
  head(state, stream, column, null, word);
  if (word.startsWith(":")) return "atom";
  if (ATOMS.has(word)) return "atom";
  return isHead && SPECIAL.has(word) ? "keyword" : "variable";
}

// Notes an item of the list that is open, for the indentation.
function head(state, stream, column, style, word = "") {
  const list = state.open.at(-1);
  if (list) {
    if (list.items === 0) list.word = word;
    if (list.items === 1) list.first = column;
    list.items++;
  }
  return style;
}

function text(stream, state) {
  if (state.end === '"') {
    while (!stream.eol()) {
      const next = stream.next();
      if (next === "\\") stream.next();
      else if (next === '"') {
        state.end = null;
        break;
      }
    }
  } else {
    const end = stream.string.indexOf(state.end, stream.pos);
    if (end < 0) stream.skipToEnd();
    else {
      stream.pos = end + state.end.length;
      state.end = null;
    }
  }
  return "string";
}

export const hy = {
  name: "hy",
  startState: () => ({ open: [], end: null }),
  copyState: ({ open, end }) => ({ open: open.map((each) => ({ ...each })), end }),
  token,
  indent(state) {
    const list = state.open.at(-1);
    if (!list || state.end !== null) return state.end === null ? 0 : null;
    if (!list.list) return list.column + 1;
    if (HAS_BODY.test(list.word ?? "")) return list.column + 2;
    return list.first ?? list.column + (list.items ? 2 : 1);
  },
  languageData: { commentTokens: { line: ";" }, closeBrackets: { brackets: ["(", "[", "{", '"'] } },
};
