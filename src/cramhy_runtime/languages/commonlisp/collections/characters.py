"""Characters: codes, names, case and comparison.

A character is a `Character`, one Unicode code point. Lisp's case is simpler than Unicode's: a character *has* case only if
its upper- and lowercase forms are single characters that map to each other, so ``ß`` and ``µ`` have none and no string ever
changes its length by ``string-upcase``. Source: ANSI chapter 13; names and tables are SBCL's.
"""

from __future__ import annotations

import re
import unicodedata

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Character, LispString
from cramhy_runtime.lisp_core.equality import folded
from cramhy_runtime.lisp_core.packages import is_symbol, string_designator, symbol_name

CONSTANTS = VARIABLES = {"CHAR-CODE-LIMIT": 0x110000}
LISP_NAMES = """
char-code code-char char-int char-name name-char character characterp
char= char/= char< char> char<= char>= char-equal char-not-equal char-lessp char-greaterp char-not-greaterp char-not-lessp
alpha-char-p digit-char-p digit-char upper-case-p lower-case-p both-case-p alphanumericp graphic-char-p standard-char-p
char-upcase char-downcase
"""


def char_of(character, context="\nwhen binding CHAR"):
    """The one-character Python string of a `Character`; anything else is a type-error."""
    if character.__class__ is not Character:
        type_error(character, "CHARACTER", context)
    return character.char


# ------------------------------------------------------------------------------------------------------------ codes and names


def char_code(character):
    """``char-code``: the Unicode code point."""
    return ord(char_of(character))


char_int = char_code


def code_char(code):
    """``code-char``: the character with that code point."""
    if code.__class__ is not int or not 0 <= code < 0x110000:
        type_error(code, "(MOD 1114112)", "\nwhen binding SB-IMPL::CODE")
    return Character(chr(code))


_CONTROL_NAMES = (
    "Nul Soh Stx Etx Eot Enq Ack Bel Backspace Tab Newline Vt Page Return So Si Dle Dc1 Dc2 Dc3 Dc4 Nak Syn Etb Can Em Sub Esc "
    "Fs Gs Rs Us Space"
).split()
_HIGH_NAMES = (
    "C80 C81 Break-Permitted No-Break-Permitted C84 Next-Line Start-Selected-Area End-Selected-Area Character-Tabulation-Set "
    "Character-Tabulation-With-Justification Line-Tabulation-Set Partial-Line-Forward Partial-Line-Backward Reverse-Linefeed "
    "Single-Shift-Two Single-Shift-Three Device-Control-String Private-Use-One Private-Use-Two Set-Transmit-State "
    "Cancel-Character Message-Waiting Start-Guarded-Area End-Guarded-Area Start-String C99 Single-Character-Introducer "
    "Control-Sequence-Introducer String-Terminator Operating-System-Command Privacy-Message Application-Program-Command"
).split()
_NAMES = {
    **{chr(code): name for code, name in enumerate(_CONTROL_NAMES)},
    "\x7f": "Rubout",
    **{chr(128 + index): name for index, name in enumerate(_HIGH_NAMES)},
}
CHARACTER_NAMES = list(_NAMES.values())
_BY_NAME = {name.upper(): char for char, name in _NAMES.items()}
_BY_NAME.update(
    ALTMODE="\x1b",
    BS="\b",
    CR="\r",
    DEL="\x7f",
    DELETE="\x7f",
    ESCAPE="\x1b",
    FF="\f",
    FORMFEED="\f",
    HT="\t",
    LF="\n",
    LINEFEED="\n",
    NL="\n",
    NULL="\0",
    SP=" ",
    BELL="\U0001f514",
)
_BY_NAME.update({f"^{chr(64 + code)}": chr(code) for code in range(32)})
_NUMBERED = "CJK UNIFIED IDEOGRAPH-"
"""How names begin that are made of the code: for Lisp these characters have names such as ``U4E00``."""
_CODE_NAME = late_pattern(r"U\+?([0-9A-F]+)", re.IGNORECASE)


def char_name(character):
    """``char-name``: the name, such as ``"Space"`` or ``"LATIN_SMALL_LETTER_A"``."""
    return character_name(char_of(character))


def character_name(char):
    """The name of the character ``char``, a Python string of length one: ``Space``, ``LATIN_SMALL_LETTER_A``, ``U4E00``."""
    if char in _NAMES:
        return _NAMES[char]
    name = unicodedata.name(char, None)
    return name.replace(" ", "_") if name and not name.startswith(_NUMBERED) else f"U{ord(char):X}"


def name_char(name):
    """``name-char``: the character of that name, in any case; nil if there is none."""
    if not isinstance(name, (str, LispString, Character)) and not is_symbol(name):
        return type_error(name, "(OR STRING SYMBOL CHARACTER)")
    name = str(string_designator(name))
    found = _BY_NAME.get(name.upper())
    if found is None:
        match = _CODE_NAME.fullmatch(name)
        if match and int(match[1], 16) < 0x110000:
            found = chr(int(match[1], 16))
        else:
            found = _of_unicode(name.upper())
    return Character(found) if found is not None else None


def _of_unicode(name):
    """The character that `character_name` names so, but for the case; ``None`` if there is none."""
    try:
        found = unicodedata.lookup(name.replace("_", " ")) if len(name) > 1 else ""
    except (KeyError, UnicodeEncodeError):  # the latter of half a surrogate pair
        return None
    return found if len(found) == 1 and character_name(found).upper() == name else None  # Python knows other names, too


def character(designator):
    """``character``: the character that a character, or a string or symbol of one character, stands for."""
    if designator.__class__ is Character:
        return designator
    if isinstance(designator, (str, LispString)):
        text, problem = str(designator), "String is not of length one: ~S"
    elif is_symbol(designator):
        text, problem = symbol_name(designator), "Symbol name is not of length one: ~S"
    else:
        text, problem = "", "~S cannot be coerced to a character."
    if len(text) == 1:
        return Character(text)
    return error(SimpleTypeError(problem, designator, datum=designator, expected_type="CHARACTER"))


def characterp(thing):
    """``characterp``: whether ``thing`` is a character."""
    return True if thing.__class__ is Character else None


# ----------------------------------------------------------------------------------------------------------------- comparison


def _comparison(name, compare, key, all_pairs=False):
    def compared(character, *characters):
        if len(characters) == 1 and character.__class__ is characters[0].__class__ is Character and not all_pairs:
            return True if compare(key(character.char), key(characters[0].char)) else None
        chars = [key(char_of(character, "\nwhen binding CHARACTER")), *(key(char_of(other, "")) for other in characters)]
        if all_pairs:
            return True if len(set(chars)) == len(chars) else None
        return True if all(compare(x, y) for x, y in zip(chars, chars[1:])) else None

    compared.__name__ = compared.__qualname__ = name
    compared.__doc__ = f"``{name}``: compare the characters in a row" + (", whatever their case." if key is folded else ".")
    return compared


for _case_sensitive, _folded, _relation in (
    ("char_eq", "char_equal", lambda x, y: x == y),
    ("char_lt", "char_lessp", lambda x, y: x < y),
    ("char_gt", "char_greaterp", lambda x, y: x > y),
    ("char_le", "char_not_greaterp", lambda x, y: x <= y),
    ("char_ge", "char_not_lessp", lambda x, y: x >= y),
):
    globals()[_case_sensitive] = _comparison(_case_sensitive, _relation, lambda char: char)
    globals()[_folded] = _comparison(_folded, _relation, folded)
char_ne = _comparison("char_ne", None, lambda char: char, all_pairs=True)
char_not_equal = _comparison("char_not_equal", None, folded, all_pairs=True)


# -------------------------------------------------------------------------------------------------------------- case and kind


def upcased(char):
    """The uppercase form of a one-character Python string that has case in Lisp's sense, else the string itself."""
    if char < "\x80":
        return char.upper()
    upper = char.upper()
    return upper if len(upper) == 1 and upper.lower() == char else char


def downcased(char):
    """The lowercase form, likewise."""
    return folded(char)


def char_upcase(character):
    """``char-upcase``: the uppercase form, or the character itself."""
    return Character(upcased(char_of(character)))


def char_downcase(character):
    """``char-downcase``: the lowercase form, or the character itself."""
    return Character(downcased(char_of(character)))


def upper_case_p(character):
    """``upper-case-p``: whether it has a different lowercase form."""
    char = char_of(character)
    return True if downcased(char) != char else None


def lower_case_p(character):
    """``lower-case-p``: whether it has a different uppercase form."""
    char = char_of(character)
    return True if upcased(char) != char else None


def both_case_p(character):
    """``both-case-p``: whether it has case at all."""
    return upper_case_p(character) or lower_case_p(character)


def alpha_char_p(character):
    """``alpha-char-p``: whether it is a letter."""
    return True if char_of(character).isalpha() else None


def is_alphanumeric(char):
    """Whether a one-character Python string is a letter or a decimal digit."""
    return char.isalpha() or char.isdecimal()


def alphanumericp(character):
    """``alphanumericp``: whether it is a letter or a decimal digit."""
    return True if is_alphanumeric(char_of(character)) else None


def graphic_char_p(character):
    """``graphic-char-p``: whether it is printed as itself: no control character."""
    code = ord(char_of(character))
    return True if 31 < code < 127 or code > 159 else None


def standard_char_p(character):
    """``standard-char-p``: whether every Common Lisp has it: ASCII's graphic characters and newline."""
    char = char_of(character)
    return True if " " <= char <= "~" or char == "\n" else None


def _radix(radix):
    if radix.__class__ is not int or not 2 <= radix <= 36:
        type_error(radix, "(INTEGER 2 36)", "\nwhen binding SB-IMPL::RADIX")
    return radix


def digit_char_p(character, radix=10):
    """``digit-char-p``: the weight of the digit in ``radix``, or nil if it is none."""
    char, radix = char_of(character), _radix(radix)
    weight = unicodedata.decimal(char, None)
    if weight is None:
        lower = char.lower()
        weight = ord(lower) - 87 if "a" <= lower <= "z" and len(lower) == 1 else 99
    return weight if weight < radix else None


def digit_char(weight, radix=10):
    """``digit-char``: the digit of that weight, or nil if ``radix`` has none."""
    _radix(radix)
    if weight.__class__ is not int or weight < 0:
        type_error(weight, "UNSIGNED-BYTE", "\nwhen binding SB-IMPL::WEIGHT")
    return Character("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"[weight]) if weight < radix else None
