"""The engine of the reader: a place in a text, and the loop that takes one object after another from it.

A `Reader` remembers the place of every list form, which the compiler puts into errors and tracebacks. Reading is driven by the
readtable (``readtables.py``): one regular expression skips to the next token; every other character calls its macro function.
Lists and the quote-like prefixes, most of any program, are read in one loop with a stack of frames instead of recursion, which is
quick and knows at the end of the text which parenthesis was never closed.

The law: whatever the text is, reading it gives data or signals a Lisp condition with file, line and column.
Source: ANSI 2.2 and 2.3.
"""

from __future__ import annotations

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.data import NO_VALUES, Character, Cons, MultipleValues, Symbol, list_from, one
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, sym
from ..streams.streams import EchoStream, FdStream, InputStream, input_stream
from . import reader_errors, tokens
from ..syntax.backquote import QUASIQUOTE, Comma
from .form_places import FormPlaces, LineIndex
from .reader_errors import fail
from .readtables import INVALID, READTABLE, SUPPRESS, UPCASE, DispatchTable, call
from .unmatched_closes import left_out, unmatched_closes

PACKAGE = special("*PACKAGE*", COMMON_LISP_USER)
QUOTE, FUNCTION = sym("QUOTE"), sym("FUNCTION")

RADIXES = {}
"""The standard functions of ``#b``, ``#o`` and ``#x``, and their bases: tables of numbers are read in one go."""
_RADIX_LETTERS = ("b", "B", "o", "O", "x", "X")
_DIGITS = late_pattern("[+-]?[0-9a-fA-F]{1,99}")

NOTHING = object()
"""What reading gives when the text ends before an object begins."""
_OPEN = object()  # the tail of a list frame without a dot
_DOT = object()  # the tail of a list frame just after the dot


class Reader(InputStream, FdStream):
    """Reads ``text``, of the file ``filename``, whose first character is at ``line`` and ``column`` (counted from 1).

    ``positions``, a `FormPlaces`, maps ``id(form)`` of every list read, and of the last symbol read at top level, to (line, column,
    end line, end column), the end being that of its last character. The forms are kept alive, so an id stays valid as long as the
    reader.

    strict: an unmatched ``)`` is an error, as for programs that call ``read``; otherwise it is warned about and ignored.
    A reader is an input stream of Lisp, because reader macro functions get it as one.
    ``noted``: the `Answered` of its text, if somebody notes how far its forms were evaluated.
    """

    noted = None

    def __init__(self, text, filename="<repl>", line=1, column=1, *, strict=False):
        self.text = text
        self.label = f"file {filename}"
        self.filename = filename
        self.offset = 0
        self.positions = FormPlaces(self.place)
        self.strict = strict
        self.stray_closes = 0  # how many ) there were that closed nothing, and where the first of them is
        self.first_stray_close = None
        self.quiet = False
        self.backquotes = 0
        self.labels = {}
        self._kept = []
        self.frames = []
        self.is_reading = False
        self._start = (line, column)
        self._lines = None

    @property
    def _text(self):  # the names under which an input stream knows its text and where it is
        return self.text

    @_text.setter
    def _text(self, text):
        self.text = text

    @property
    def _position(self):
        return self.offset

    @_position.setter
    def _position(self, offset):
        self.offset = offset

    @property
    def stream(self):
        """The stream that conditions name."""
        return self

    def grow(self):
        """Append what arrives next, if anything does, to the text; whether something did."""
        piece = self.more()
        if piece:
            self.text += piece
        return bool(piece)

    # ------------------------------------------------------------------------------------------------------------- places

    @property
    def lines(self):
        """The `LineIndex` of the text."""
        if self._lines is None or self._lines.text is not self.text:
            self._lines = LineIndex(self.text, *self._start)
        return self._lines

    def place(self, offset):
        """(line, column) of an offset of the text."""
        return self.lines.place(offset)

    @property
    def position(self):
        """(line, column) of the next character."""
        return self.place(self.offset)

    def remember(self, form, start, symbols=()):
        """Note that ``form`` was read from ``start`` up to here. symbols: the index and the offset of each symbol in it."""
        place, key = self.lines.place, id(form)
        self.positions[key] = place(start) + place(self.offset - 1)
        if symbols:
            self.positions.symbols[key] = symbols
        self._kept.append(form)

    def __repr__(self):
        return f'#<READER for "{self.filename}">'

    # ------------------------------------------------------------------------------------------------------------ reading

    def read(self, eof_error=True, eof_value=None):
        """The next object. At the end of the text signal end-of-file, or return ``eof_value``."""
        if self.is_reading:  # a reader macro function reads on
            found = self.next_object()
        else:
            self.backquotes, self.labels = 0, {}
            self.is_reading = True
            try:
                self.skip_blank()
                start = self.offset
                found = self.next_object()
                while not (self.strict or self.quiet or found is NOTHING or self.offset == len(self.text)) and left_out(self, start):
                    self.skip_blank()
                    start = self.offset
                    found = self.next_object()
                if isinstance(found, Symbol):  # an unbound variable at top level has a place too; a symbol read again gets a new one
                    self.remember(found, start)
            except RecursionError:
                found = fail(
                    self,
                    min(self.offset, len(self.text)),
                    "The text is nested too deeply to be read.",
                    hint="Reader macros such as #( and #+ can be some hundred levels deep.",
                )
            finally:
                self.is_reading = False
        if found is not NOTHING:
            return found
        if eof_error is None or eof_error is False:
            return eof_value
        return self.ended()

    def read_all(self):
        """Yield (object, (line, column)) for every object up to the end of the text."""
        while True:
            self.skip_blank()
            start = self.offset
            found = self.read(False, NOTHING)
            if found is NOTHING:
                return
            yield found, self.positions[id(found)][:2] if id(found) in self.positions else self.place(start)

    def skip_blank(self):
        """Go past white space and comments that begin with ``;``."""
        self.offset = READTABLE.value.end_of_blank(self.text, self.offset)

    def next_object(self, frame=None):
        """The next object, or NOTHING at the end of the text.

        frame: a list or prefix that has begun already.
        """
        base = len(self.frames)
        try:
            if frame is not None:
                self.frames.append(frame)
            return self._next(base)
        except BaseException:
            del self.frames[base:]
            raise

    def required(self):
        """The next object; the end of the text is an error."""
        found = self.next_object()
        return self.ended() if found is NOTHING else found

    def ended(self, context=None):
        """Signal that the text ends inside what is being read."""
        return reader_errors.end_of_file(self, [(frame[1], frame[3]) for frame in self.frames], context)

    def _next(self, base):
        frames = self.frames
        while True:
            if len(frames) > MOST_NESTED:
                return fail(self, self.offset, "The text is nested too deeply to be read.", hint=f"{MOST_NESTED} levels are the most.")
            text, table = self.text, READTABLE.value
            match = (table.scanner or table.compiled()).match(text, self.offset)
            start, end = match.span(1)
            at = start
            if match.end(2) > end:
                found = self._escaped_token(start, table)
            elif end > start:
                if end == len(text) and self.grow():
                    continue
                self.offset = end
                word = match[1]
                if word == "." and SUPPRESS.value is None:
                    _see_dot(self, start, base)
                    continue
                found = self._token(word, start, table)
            elif end == len(text):
                self.offset = table.end_of_blank(text, self.offset)
                if self.grow():
                    continue
                self.offset = end
                if len(frames) > base:
                    return self.ended()
                return NOTHING
            else:
                char = text[end]
                self.offset = end + 1
                handler = table.macros[char]
                at = end
                if handler is read_list:
                    frames.append([[], end, _OPEN, "(", []])
                    continue
                if handler is read_close:
                    if len(frames) > base and frames[-1][0] is not None:
                        found = _closed_list(self, frames.pop(), end)
                    elif not frames and not self.strict and unmatched_closes(self, end):
                        continue
                    else:
                        return _misplaced_close(self, end)
                elif handler in _PREFIXES:
                    frames.append(_prefix_frame(self, handler, end))
                    continue
                elif text.startswith("'", end + 1) and _is_sharp_quote(handler):
                    self.offset = end + 2
                    frames.append([None, end, FUNCTION, "#'"])
                    continue
                elif handler.__class__ is DispatchTable and (number := self._numeral(handler, end, table)) is not None:
                    found = number
                else:
                    found = self.call_macro(handler, char, end)
                    if found is NOTHING:
                        continue
            while True:  # put the object where it belongs: into the list around it, or behind its prefix
                if len(frames) == base:
                    return found
                frame = frames[-1]
                if frame[0] is not None:
                    if frame[2] is _OPEN:
                        if found.__class__ is Symbol:
                            frame[4].append((len(frame[0]), at))
                        frame[0].append(found)
                    elif frame[2] is _DOT:
                        frame[2] = found
                    else:
                        hint = "After the dot and one object the list must end."
                        return fail(self, start if end > start else end, "More than one object follows . in list.", hint=hint)
                    break
                frames.pop()
                found = _prefixed(self, frame, found, at)

    # ------------------------------------------------------------------------------------------------------ macro functions

    def call_macro(self, handler, char, start):
        """What a macro function reads; NOTHING when it returns no value, as comments do."""
        self.frames.append([None, start, None, char])
        backquotes = self.backquotes
        result = call(handler, self, Character(char))
        self.backquotes = backquotes
        self.frames.pop()
        return NOTHING if result is NO_VALUES or result == () and result.__class__ is MultipleValues else one(result)

    def objects_until(self, close):
        """The objects up to the character ``close``, which is consumed."""
        base = len(self.frames)
        self.frames.append([None, max(0, self.offset - 1), None, self.text[max(0, self.offset - 1) : self.offset] or close])
        found = []
        try:
            while True:
                self.skip_blank()
                if self.offset == len(self.text):
                    if self.grow():
                        continue
                    return self.ended()
                char = self.text[self.offset]
                if char == close:
                    self.offset += 1
                    return found
                handler = READTABLE.value.macros.get(char)
                if handler is None or handler is read_list or handler in _PREFIXES:
                    item = self.required()
                else:
                    self.offset += 1
                    item = self.call_macro(handler, char, self.offset - 1)
                if item is not NOTHING:
                    found.append(item)
        finally:
            del self.frames[base:]

    def frame_start(self):
        """The offset at which what is being read by the innermost macro function begins."""
        return self.frames[-1][1] if self.frames else self.offset

    def describe_frame(self, opener, start=None):
        """Name what the macro function being called reads, for the report that the text ended in it."""
        if self.frames:
            frame = self.frames[-1]
            frame[3] = opener
            if start is not None:
                frame[1] = start

    # --------------------------------------------------------------------------------------------------------------- tokens

    def _token(self, word, start, table):
        """The number or symbol of a token without escapes."""
        if SUPPRESS.value is not None:
            return None
        if word[0] in "0123456789+-." or tokens.READ_BASE.value != 10:
            try:
                number = tokens.number(word)
            except tokens.NumberError as problem:
                return fail(self, start, str(problem), hint=problem.hint, kind=reader_errors.ImpossibleNumber)
            if number is not None:
                return number
            if not word.strip("."):
                return fail(self, start, "too many dots", hint="Dots alone name nothing; write \\... for a symbol of dots.")
        if not word.isascii():
            word = tokens.normalized(word)
        convert = _case_function(table)
        if ":" not in word:
            name = convert(word)
            package = PACKAGE.value
            found, status = package.lookup(name)
            return found if status else package.intern(name)
        return tokens.qualified_symbol(self, word.split(":"), convert, word, start)

    def _numeral(self, handler, start, table):
        """The integer such as ``#xFF`` at ``start``, read in one go; ``None`` where the readtable's own function has to look."""
        text = self.text
        if text[start + 1 : start + 2] not in _RADIX_LETTERS or SUPPRESS.value is not None:
            return None
        base = RADIXES.get(handler.functions.get(text[start + 1].upper()))
        match = table.scanner.match(text, start + 2)
        if base is None or match.start(1) > start + 2 or match.end() > match.end(1) or match.end() == len(text):
            return None
        if not _DIGITS.fullmatch(match[1]):
            return None
        try:
            number = int(match[1], base)
        except ValueError:  # a digit that the base has not
            return None
        self.offset = match.end()
        return number

    def _escaped_token(self, start, table):
        """The symbol of a token with ``\\`` or ``|``; those characters are taken as they are, and it is never a number."""
        self.offset = start
        parts, _, word = self.token_parts()
        if SUPPRESS.value is not None:
            return None
        if len(parts) == 1:
            return PACKAGE.value.intern(parts[0])
        return tokens.qualified_symbol(self, parts, str, word, start)

    def token_parts(self):
        """Take a token: (the texts between its colons, whether it has escapes, the token as written)."""
        table = READTABLE.value
        convert = _case_function(table)
        start = index = self.offset
        parts, plain, escaped = [[]], [], False  # a part is a list of (text, whether it was written without escapes)

        def name_so_far():
            parts[-1].append((tokens.normalized("".join(plain)), True))
            plain.clear()

        while index < len(self.text) or self.grow():
            char = self.text[index]
            if char in table.single_escapes:
                escaped = True
                index += 1
                name_so_far()
                parts[-1].append((self._escaped(index, start, "token", "after single-escape character"), False))
            elif char in table.multiple_escapes:
                escaped = True
                name_so_far()
                bar = index
                index += 1
                while (char := self._escaped(index, bar, "|")) not in table.multiple_escapes:
                    if char in table.single_escapes:
                        index += 1
                        char = self._escaped(index, bar, "|")
                    parts[-1].append((char, False))
                    index += 1
            elif table.terminates(char):
                break
            elif char in INVALID:
                return fail(self, index, "illegal character ~S", Character(char), hint="Write \\ before it.")
            elif char == ":":
                name_so_far()
                parts.append([])
            else:
                plain.append(char)
            index += 1
        self.offset = index
        name_so_far()
        return [tokens.in_case(part, convert) for part in parts], escaped, self.text[start:index]

    def _escaped(self, index, start, opener, context=None):
        """The character at ``index``; the end of the text is an error in what began at ``start``."""
        if index < len(self.text) or self.grow():
            return self.text[index]
        self.offset = index
        self.frames.append([None, start, None, opener])
        return self.ended(context)


def _case_function(table):
    return tokens.upcase if table.case is UPCASE else tokens.CASES[table.case.name]


# --------------------------------------------------------------------------------------------------- lists and prefixes


def _see_dot(reader, start, base):
    frame = reader.frames[-1] if len(reader.frames) > base else None
    if frame is None or frame[0] is None:
        fail(reader, start, "dot context error", hint="A dot alone has a meaning only in a list: (a . b).")
    elif not frame[0]:
        fail(reader, start, "Nothing appears before . in list.", hint="A dotted pair is (a . b).")
    elif frame[2] is not _OPEN:
        fail(reader, start, "dot context error", hint="A list has at most one dot: (a b . c).")
    frame[2] = _DOT


def _closed_list(reader, frame, close):
    items, start, tail, _, symbols = frame
    if tail is _OPEN:
        tail = None
    elif tail is _DOT:
        return fail(reader, close, "Nothing appears after . in list.", hint="A dotted pair is (a . b).")
    elif isinstance(tail, Comma) and tail.splicing:
        for item in reversed(items):
            tail = Cons(item, tail)
        return fail(reader, start, "~S contains a splicing comma after a dot", tail, hint="After a dot write , instead of ,@.")
    if SUPPRESS.value is not None:
        return None
    made = list_from(items, tail)
    if made is not None:
        reader.remember(made, start, symbols)
    return made


def _misplaced_close(reader, offset):
    opener = reader.frames[-1][3] if reader.frames else None
    if opener in _COMMAS:
        return fail(
            reader,
            offset,
            f"Trailing {_COMMAS[opener]} in backquoted expression.",
            hint=f"Something must follow the {opener} before the ).",
        )
    hint = f"Something must follow the {opener} before the )." if opener else "There is one ) too many, or a ( is missing before it."
    return fail(reader, offset, "unmatched close parenthesis", hint=hint)


def _prefix_frame(reader, handler, start):
    """The frame for the quote, backquote or comma at ``start``."""
    symbol, opener = _PREFIXES[handler]
    if symbol is QUASIQUOTE:
        reader.backquotes += 1
    elif symbol is Comma:
        if not reader.backquotes and SUPPRESS.value is None:
            fail(reader, start, "Comma not inside a backquote.", hint=reader_errors.comma_hint(reader.text, start))
        following = reader.peek_char()
        if following and following in "@.":
            reader.offset += 1
            opener += following
        reader.backquotes -= 1
    return [None, start, symbol, opener]


def _prefixed(reader, frame, found, at):
    _, start, symbol, opener = frame
    if SUPPRESS.value is not None:
        reader.backquotes += (symbol is Comma) - (symbol is QUASIQUOTE)
        return None
    if symbol is Comma:
        reader.backquotes += 1
        comma = Comma(opener, found)
        if found.__class__ is Symbol:
            reader.positions.symbols[id(comma)] = [(0, at)]
        return comma
    if symbol is QUASIQUOTE:
        reader.backquotes -= 1
        if isinstance(found, Comma) and found.splicing:
            return fail(
                reader,
                start,
                "~S is not a well-formed backquote expression",
                Cons(symbol, Cons(found)),
                hint=f"{found.kind} splices into a list, so it must stand in one: `({found.kind}x).",
            )
    form = Cons(symbol, Cons(found))
    reader.remember(form, start)
    return form


# ------------------------------------------------------------------- lists and prefixes as reader macro functions


def read_list(stream, character):
    """``(``: a list."""
    reader = as_reader(stream)
    return reader.next_object([[], reader.offset - 1, _OPEN, "(", []])


def read_close(stream, character):
    """``)`` where no list is open."""
    reader = as_reader(stream)
    return _misplaced_close(reader, reader.offset - 1)


def _prefix_reader(name, documentation):
    def function(stream, character):
        reader = as_reader(stream)
        return reader.next_object(_prefix_frame(reader, function, reader.offset - 1))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = documentation
    return function


read_quote = _prefix_reader("read_quote", "``'x`` is ``(quote x)``.")
read_backquote = _prefix_reader("read_backquote", "A template: see ``syntax/backquote.py``.")
read_comma = _prefix_reader("read_comma", "``,x``, ``,@x``, ``,.x``: a place to be filled in a template.")

MOST_NESTED = 100_000
_COMMAS = {",": "comma", ",@": "comma-at", ",.": "comma-dot"}
_PREFIXES = {read_quote: (QUOTE, "'"), read_backquote: (QUASIQUOTE, "`"), read_comma: (Comma, ",")}


def sharp_quote(stream, sub, argument):
    """``#'f`` is ``(function f)``."""
    reader = as_reader(stream)
    return reader.next_object([None, reader.frame_start(), FUNCTION, "#'"])


def _is_sharp_quote(handler):
    return handler.__class__ is DispatchTable and handler.functions.get("'") is sharp_quote


class StreamReader(Reader):
    """Reads on from where an input stream is; `release` puts the stream behind what was read."""

    def __init__(self, source, strict=True, echoes=()):
        super().__init__(source._text, getattr(source, "label", "a stream"), strict=strict)
        self.offset = self.begun = source._position
        self.source = source
        self.echoes = echoes  # where what is read is shown

    @property
    def stream(self):
        return self.source

    def more(self):
        return self.source.more()

    def release(self):
        self.source.put_back(self.text, self.offset)
        for echo in self.echoes:
            echo.write(self.text[self.begun : self.offset])


def as_reader(stream):
    """The `Reader` for a stream argument; of a stream that is none, a `StreamReader`."""
    if isinstance(stream, Reader):
        return stream
    stream, echoes = input_stream(stream), []
    while hasattr(stream, "source") and not isinstance(stream, Reader):  # two-way, echo and synonym streams
        if isinstance(stream, EchoStream):
            echoes.append(stream.sink)
        stream = stream.source
    if isinstance(stream, Reader):
        return stream
    return StreamReader(stream, echoes=echoes)
