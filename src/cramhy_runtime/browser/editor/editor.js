// The editor: CodeMirror with Common Lisp and Hy, as the page wants it. `bundling.py` makes one file of this and of CodeMirror.
//
// It stands in a shadow root. There CodeMirror takes style sheets that are made by script, which the policy of the site allows, and not
// style elements, which it forbids. The colours are those of the page, whose variables are inherited.

import { acceptCompletion, autocompletion, completionKeymap, completionStatus, startCompletion } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentSelection } from "@codemirror/commands";
import { bracketMatching, HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { commonLisp } from "@codemirror/legacy-modes/mode/commonlisp";
import { Compartment, EditorState, Prec } from "@codemirror/state";
import { EditorView, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { hy } from "./hy.js";

const LANGUAGES = { lisp: StreamLanguage.define(commonLisp), hy: StreamLanguage.define(hy), text: [] };

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--good)" },
  { tag: [tags.keyword, tags.standard(tags.variableName)], color: "var(--accent)", fontWeight: "600" },
  { tag: [tags.atom, tags.meta], color: "var(--wait)" },
  { tag: tags.number, color: "var(--warn)" },
  { tag: tags.invalid, color: "var(--bad)" },
]);

const looks = EditorView.theme({
  "&": { height: "100%", color: "var(--ink)", backgroundColor: "transparent", fontSize: "inherit" },
  "&.cm-focused": { outline: "max(2px, 0.15rem) solid var(--accent)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.45", overflow: "auto" },
  ".cm-content": { caretColor: "var(--ink)", padding: "0.35rem 0" },
  ".cm-gutters": { color: "var(--soft)", backgroundColor: "transparent", border: "none" },
  "&.cm-focused .cm-matchingBracket, .cm-matchingBracket": {
    backgroundColor: "var(--accent-wash)", outline: "1px solid var(--accent)", borderRadius: "2px",
  },
  "&.cm-focused .cm-nonmatchingBracket": { backgroundColor: "transparent", color: "var(--bad)", textDecoration: "underline wavy" },
  ".cm-tooltip": { backgroundColor: "var(--sheet)", color: "var(--ink)", border: "var(--line) solid var(--edge)", borderRadius: "0.4rem" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono)", maxHeight: "14em", maxWidth: "min(36rem, 90vw)" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li": { padding: "0.2rem 0.5rem" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--on-accent)" },
  ".cm-completionDetail": { fontStyle: "normal", opacity: "0.8" },
});

export class Editor {
  // place: the element that it stands in. id, label: of the text that is edited. complete(before): promises {length, options: [[name, what
  // is known of it]]} for the text before the cursor. keys: CodeMirror's bindings, that go before its own. changed(): the user has changed
  // the text. moved(): the cursor is elsewhere. numbers: whether the lines have numbers.
  constructor({ place, id, label, complete, keys = [], changed = () => {}, moved = () => {}, numbers = false, describedBy = null }) {
    const root = place.attachShadow({ mode: "open" });
    this.language = "lisp";
    this.complete = complete;
    const named = { id, "aria-label": label, "aria-description": describedBy ?? "" };
    this.syntax = new Compartment();
    this.parts = [
      numbers ? lineNumbers() : [],
      history(),
      bracketMatching(),
      syntaxHighlighting(colours),
      looks,
      EditorView.lineWrapping,
      EditorView.contentAttributes.of({ ...named, autocapitalize: "off", autocorrect: "off", spellcheck: "false" }),
      autocompletion({ override: [(context) => this.#completions(context)], activateOnTyping: false, interactionDelay: 0, icons: false }),
      Prec.highest(keymap.of(keys)),
      keymap.of([
        { key: "Tab", run: (view) => acceptCompletion(view) || this.#indentOrComplete(view) },
        ...completionKeymap, ...historyKeymap, ...defaultKeymap,
      ]),
      EditorView.updateListener.of((update) => {
        if (update.docChanged && !this.opening) changed();
        if (update.docChanged || update.selectionSet) moved();
      }),
    ];
    this.view = new EditorView({ state: this.#state(""), parent: root, root });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  // All of the text, as the user's change, which can be undone. The cursor is behind it.
  set text(text) {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, selection: { anchor: text.length } });
  }

  get cursor() {
    return this.view.state.selection.main.head;
  }

  set cursor(place) {
    this.view.dispatch({ selection: { anchor: Math.max(0, Math.min(place, this.view.state.doc.length)) }, scrollIntoView: true });
  }

  // The text that is chosen: {from, to, text}.
  get chosen() {
    const { from, to } = this.view.state.selection.main;
    return { from, to, text: this.view.state.sliceDoc(from, to) };
  }

  // Whether completions are offered now.
  get completes() {
    return completionStatus(this.view.state) === "active";
  }

  // {line, column} of a place, each from 1.
  placeOf(place) {
    const { number, from } = this.view.state.doc.lineAt(place);
    return { line: number, column: place - from + 1 };
  }

  // Begin with another text, in "lisp", "hy" or "text". kept: what `leave` has returned for that text, with its history and its cursor.
  open(text, language, kept = null) {
    this.language = language;
    this.opening = true;
    this.view.setState(kept && kept.doc.toString() === text ? kept : this.#state(text));
    this.opening = false;
    this.speak(language);
  }

  // The language of the text is another one from now on.
  speak(language) {
    this.language = language;
    this.view.dispatch({ effects: this.syntax.reconfigure(LANGUAGES[language]) });
  }

  // What `open` needs in order to go on here.
  leave() {
    return this.view.state;
  }

  insert(text) {
    this.view.dispatch(this.view.state.replaceSelection(text));
  }

  focus() {
    this.view.focus();
  }

  #state(text) {
    return EditorState.create({ doc: text, extensions: [...this.parts, this.syntax.of(LANGUAGES[this.language])] });
  }

  // As in SLIME: at the beginning of a line Tab indents it, and behind a word it completes.
  #indentOrComplete(view) {
    const { main } = view.state.selection;
    if (!main.empty || !view.state.sliceDoc(view.state.doc.lineAt(main.head).from, main.head).trim()) {
      return view.state.doc.length > 0 && indentSelection(view);
    }
    return startCompletion(view);
  }

  async #completions({ state, pos, explicit }) {
    if (!explicit && completionStatus(state) === null) return null;
    const found = await this.complete(state.sliceDoc(0, pos));
    if (!found?.options.length) return null;
    const options = found.options.map(([label, detail]) => ({ label, detail }));
    return { from: pos - found.length, options, validFor: /^[^\s()[\]{}'"`,;]*$/ };
  }
}
