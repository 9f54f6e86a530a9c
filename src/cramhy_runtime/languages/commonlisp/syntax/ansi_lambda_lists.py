"""The lambda lists of the functions of Common Lisp (ANSI; with the keywords that SBCL adds).

What the compiler compares calls with, and what ``describe`` shows. The functions themselves are Python's and sometimes take
their arguments in another way, so this is written down. One entry per lambda list, then the functions that have it.
"""

from __future__ import annotations

import re
from functools import cache

from cramhy_runtime.lisp_core.dispatch.methods import Shape
from cramhy_runtime.lisp_core.packages import sym

TABLE = """
(&rest numbers) * +
(number &rest more-numbers) - / /= < <= = > >= max min
(number) 1+ 1- abs acos acosh asin asinh atanh conjugate cos cosh denominator evenp exp imagpart lognot minusp numerator oddp phase
  plusp rational rationalize realpart signum sin sinh sqrt tan tanh zerop
(&optional condition) abort compute-restarts continue muffle-warning
(key datum alist) acons
(generic-function method) add-method remove-method
(item list &key key test test-not) adjoin member
(array dimensions &key element-type initial-element initial-contents fill-pointer displaced-to displaced-index-offset) adjust-array
(array) adjustable-array-p array-dimensions array-displacement array-element-type array-has-fill-pointer-p array-rank array-total-size
(class &rest initargs) allocate-instance
(char) alpha-char-p alphanumericp both-case-p char-code char-downcase char-int char-name char-upcase graphic-char-p lower-case-p
  standard-char-p upper-case-p
(&rest lists) append nconc
(function arg &rest arguments) apply
(string &optional package external-only) apropos apropos-list
(array &rest subscripts) aref array-in-bounds-p array-row-major-index
(condition) arithmetic-error-operands arithmetic-error-operation cell-error-name file-error-pathname invoke-debugger
  package-error-package print-not-readable-object simple-condition-format-arguments simple-condition-format-control stream-error-stream
  type-error-datum type-error-expected-type unbound-slot-instance
(array axis-number) array-dimension
(object) arrayp atom bit-vector-p character characterp class-of compiled-function-p complexp consp copy-tree endp floatp functionp
  hash-table-p identity inspect integerp keywordp listp not null numberp packagep pathnamep prin1-to-string princ-to-string
  random-state-p rationalp readtablep realp simple-bit-vector-p simple-string-p simple-vector-p stringp sxhash symbolp type-of vectorp
(integer count) ash
(item alist &key key test test-not) assoc rassoc
(predicate alist &key key) assoc-if assoc-if-not rassoc-if rassoc-if-not
(y &optional x) atan
(bit-array &rest subscripts) bit
(bit-array-1 bit-array-2 &optional result-bit-array) bit-and bit-andc1 bit-andc2 bit-eqv bit-ior bit-nand bit-nor bit-orc1 bit-orc2
  bit-xor
(bit-array &optional result-bit-array) bit-not
(op integer1 integer2) boole
(symbol) boundp make-synonym-stream makunbound special-operator-p symbol-function symbol-name symbol-package symbol-plist symbol-value
(&optional datum &rest arguments) break
(stream) broadcast-stream-streams concatenated-stream-streams echo-stream-input-stream echo-stream-output-stream file-length
  get-output-stream-string input-stream-p interactive-stream-p open-stream-p output-stream-p stream-element-type stream-external-format
  streamp two-way-stream-input-stream two-way-stream-output-stream
(list &optional n) butlast last nbutlast
(size position) byte
(bytespec) byte-position byte-size
(list) caaaar caaadr caaar caadar caaddr caadr caar cadaar cadadr cadar caddar cadddr caddr cadr car cdaaar cdaadr cdaar cdadar cdaddr
  cdadr cdar cddaar cddadr cddar cdddar cddddr cdddr cddr cdr copy-list eighth fifth first fourth list-length ninth rest second seventh
  sixth tenth third values-list
(number &optional divisor) ceiling fceiling ffloor floor fround ftruncate round truncate
(continue-string datum &rest arguments) cerror
(instance new-class &rest initargs &key &allow-other-keys) change-class
(string index) char schar
(character &rest more-characters) char-equal char-greaterp char-lessp char-not-equal char-not-greaterp char-not-lessp char/= char<
  char<= char= char> char>=
(theta) cis
(class) class-name make-instances-obsolete
(&optional stream) clear-input clear-output finish-output force-output fresh-line listen terpri
(stream &key abort) close
(hash-table) clrhash hash-table-count hash-table-rehash-size hash-table-rehash-threshold hash-table-size hash-table-test
(code) code-char
(object output-type-spec) coerce
(name &optional definition) compile
(input-file &key output-file verbose print external-format) compile-file
(input-file &key output-file &allow-other-keys) compile-file-pathname
(name &optional env) compiler-macro-function
(function) complement function-lambda-expression
(realpart &optional imagpart) complex
(generic-function arguments) compute-applicable-methods
(result-type &rest sequences) concatenate
(object-1 object-2) cons
(value) constantly
(form &optional environment) constantp get-setf-expansion
(alist) copy-alist
(&optional table) copy-pprint-dispatch
(&optional from-readtable to-readtable) copy-readtable
(sequence) copy-seq length nreverse reverse
(structure) copy-structure
(symbol &optional copy-props) copy-symbol
(item sequence &key from-end start end key test test-not) count find position
(predicate sequence &key from-end start end key) count-if count-if-not find-if find-if-not position-if position-if-not
(float) decode-float float-digits float-precision float-radix integer-decode-float
(universal-time &optional time-zone) decode-universal-time
(item sequence &key from-end test test-not start end count key) delete remove
(sequence &key test test-not start end from-end key) delete-duplicates remove-duplicates
(file) delete-file
(predicate sequence &key from-end start end count key) delete-if delete-if-not remove-if remove-if-not
(package-designator) delete-package find-package package-name package-nicknames package-shadowing-symbols package-use-list
  package-used-by-list
(newbyte bytespec integer) deposit-field dpb
(object &optional stream-designator) describe
(object stream) describe-object print-object
(weight &optional radix) digit-char
(char &optional radix) digit-char-p
(pathspec &key resolve-symlinks) directory
(pathname) directory-namestring file-namestring host-namestring namestring pathname-version
(object &key stream use-labels) disassemble
(x doc-type) documentation
(&optional pathname &key if-exists) dribble
(&optional x) ed gensym
(sequence index) elt
(second minute hour date month year &optional time-zone) encode-universal-time
(pathname &optional defaults) enough-namestring
(pathspec &key verbose mode) ensure-directories-exist
(function-name &key argument-precedence-order declare documentation environment generic-function-class lambda-list method-class
  method-combination) ensure-generic-function
(x y) eq eql equal equalp nreconc revappend
(datum &rest arguments) error signal warn
(form) eval
(predicate first-sequence &rest more-sequences) every notany notevery some
(symbols &optional package) export import shadow shadowing-import unexport
(base power) expt
(name) fboundp fdefinition fmakunbound name-char
(pathspec) file-author file-write-date logical-pathname pathname probe-file truename
(stream &optional position) file-position
(stream object) file-string-length
(sequence item &key start end) fill
(vector) fill-pointer vector-pop
(string-designator) find-all-symbols
(symbol &optional errorp environment) find-class
(generic-function qualifiers specializers &optional errorp) find-method
(identifier &optional condition) find-restart
(name &optional package) find-symbol intern
(number &optional prototype) float
(float-1 &optional float-2) float-sign
(destination control-string &rest format-arguments) format
(function &rest arguments) funcall
(method) function-keywords method-qualifiers
(&rest integers) gcd lcm logand logeqv logior logxor
(&optional prefix package) gentemp
(symbol indicator &optional default) get
() get-decoded-time get-internal-real-time get-internal-run-time get-universal-time lisp-implementation-type lisp-implementation-version
  list-all-packages long-site-name machine-instance machine-type machine-version short-site-name software-type software-version
(disp-char sub-char &optional readtable) get-dispatch-macro-character
(char &optional readtable) get-macro-character
(place indicator-list) get-properties
(place indicator &optional default) getf
(key hash-table &optional default) gethash
(instance &rest initargs &key &allow-other-keys) initialize-instance reinitialize-instance
(integer) integer-length logcount
(list1 list2 &key key test test-not) intersection nintersection nset-difference nset-exclusive-or nunion set-difference set-exclusive-or
  subsetp union
(method format-control &rest format-arguments) invalid-method-error
(restart &rest values) invoke-restart
(restart) invoke-restart-interactively restart-name
(n) isqrt
(bytespec integer) ldb ldb-test mask-field
(list object) ldiff
(&rest objects) list values vector
(object &rest more-objects) list*
(filespec &key verbose print if-does-not-exist external-format) load
(host) load-logical-pathname-translations logical-pathname-translations
(number &optional base) log
(integer1 integer2) logandc1 logandc2 lognand lognor logorc1 logorc2 logtest
(index integer) logbitp
(symbol &optional env) macro-function
(form &optional env) macroexpand macroexpand-1
(dimensions &key element-type initial-element initial-contents adjustable fill-pointer displaced-to displaced-index-offset) make-array
(&rest streams) make-broadcast-stream make-concatenated-stream
(type &rest initargs) make-condition
(char &optional non-terminating-p readtable) make-dispatch-macro-character
(input-stream output-stream) make-echo-stream make-two-way-stream
(&key test size rehash-size rehash-threshold hash-function weakness synchronized) make-hash-table
(class &rest initargs &key &allow-other-keys) make-instance
(size &key initial-element) make-list
(object &optional environment) make-load-form
(object &key slot-names environment) make-load-form-saving-slots
(name &key use nicknames internal-symbols external-symbols) make-package
(&key host device directory name type version defaults case) make-pathname
(&optional state) make-random-state
(result-type length &key initial-element) make-sequence
(count &key element-type initial-element) make-string
(string &optional start end) make-string-input-stream
(&key element-type) make-string-output-stream
(string) make-symbol
(result-type function first-sequence &rest more-sequences) map
(result-sequence function &rest sequences) map-into
(function list &rest more-lists) mapc mapcan mapcar mapcon mapl maplist
(function-designator hash-table) maphash
(test list &key key) member-if member-if-not
(result-type sequence1 sequence2 predicate &key key) merge
(pathname &optional defaults default-version) merge-pathnames
(format-control &rest format-arguments) method-combination-error
(sequence1 sequence2 &key from-end test test-not start1 end1 start2 end2 key) mismatch
(number divisor) mod rem
(generic-function &rest args) no-applicable-method
(generic-function method &rest args) no-next-method
(string &key start end) nstring-capitalize nstring-downcase nstring-upcase string-capitalize string-downcase string-upcase
(alist tree &key key test test-not) nsublis sublis
(new old tree &key key test test-not) nsubst subst
(new test tree &key key) nsubst-if nsubst-if-not subst-if subst-if-not
(new old sequence &key from-end test test-not start end count key) nsubstitute substitute
(new predicate sequence &key from-end start end count key) nsubstitute-if nsubstitute-if-not substitute-if substitute-if-not
(n list) nth nthcdr
(filename &key direction element-type if-exists if-does-not-exist external-format) open
(keys data &optional alist) pairlis
(string &key start end radix junk-allowed) parse-integer
(thing &optional host defaults &key start end junk-allowed) parse-namestring
(pathname &key case) pathname-device pathname-directory pathname-host pathname-name pathname-type
(in-pathname in-wildname) pathname-match-p
(&optional peek-type stream eof-error-p eof-value recursive-p) peek-char
(object &optional stream) pprint prin1 princ print
(object &optional table) pprint-dispatch
(stream list &optional colon? atsign?) pprint-fill pprint-linear
(relative-to n &optional stream) pprint-indent
(kind &optional stream) pprint-newline
(kind colnum colinc &optional stream) pprint-tab
(stream list &optional colon? atsign? tabsize) pprint-tabular
(declaration-specifier) proclaim
(module-name) provide
(limit &optional random-state) random
(&optional stream eof-error-p eof-value recursive-p) read read-char read-char-no-hang read-line read-preserving-whitespace
(stream &optional eof-error-p eof-value) read-byte
(char &optional stream recursive-p) read-delimited-list
(string &optional eof-error-p eof-value &key start end preserve-whitespace) read-from-string
(sequence stream &key start end) read-sequence write-sequence
(readtable) readtable-case
(function sequence &key key from-end start end initial-value) reduce
(key hash-table) remhash
(symbol indicator) remprop
(file new-name) rename-file
(package-designator name &optional nicknames) rename-package
(target-sequence source-sequence &key start1 end1 start2 end2) replace
(module-name &optional pathnames) require
(&optional verbosity) room
(array index) row-major-aref
(cons x) rplaca rplacd
(simple-bit-array &rest subscripts) sbit
(float integer) scale-float
(sub-sequence main-sequence &key from-end test test-not start1 end1 start2 end2 key) search
(symbol new-value) set
(disp-char sub-char function &optional readtable) set-dispatch-macro-character
(char function &optional non-terminating-p readtable) set-macro-character
(type function &optional priority table) set-pprint-dispatch
(to-char from-char &optional to-readtable from-readtable) set-syntax-from-char
(instance slot-names &rest initargs &key &allow-other-keys) shared-initialize
(seconds) sleep
(object slot-name) slot-boundp slot-exists-p slot-makunbound slot-value
(class instance slot-name operation &optional new-value) slot-missing
(class instance slot-name) slot-unbound
(sequence predicate &key key) sort stable-sort
(value &optional condition) store-value use-value
(x) string
(string1 string2 &key start1 end1 start2 end2) string-equal string-greaterp string-lessp string-not-equal string-not-greaterp
  string-not-lessp string/= string< string<= string= string> string>=
(char-bag string) string-left-trim string-right-trim string-trim
(sequence start &optional end) subseq
(type1 type2 &optional environment) subtypep
(simple-vector index) svref
(synonym-stream) synonym-stream-symbol
(object list) tailp
(pathname &key &allow-other-keys) translate-logical-pathname
(source from-wildname to-wildname &key &allow-other-keys) translate-pathname
(x y &key test test-not) tree-equal
(object type &optional environment) typep
(symbol &optional package) unintern
(character &optional stream) unread-char write-char
(packages-to-unuse &optional package) unuse-package
(previous current &rest initargs) update-instance-for-different-class
(instance added-slots discarded-slots property-list &rest initargs) update-instance-for-redefined-class
(spec &optional environment) upgraded-array-element-type upgraded-complex-part-type
(packages-to-use &optional package) use-package
(&optional host) user-homedir-pathname
(new-element vector) vector-push
(new-element vector &optional extension) vector-push-extend
(pathname &optional field-key) wild-pathname-p
(object &key stream array base case circle escape gensym length level lines miser-width pprint-dispatch pretty radix readably
  right-margin suppress-errors) write
(byte stream) write-byte
(string &optional stream &key start end) write-line write-string
(object &key array base case circle escape gensym length level lines miser-width pprint-dispatch pretty radix readably right-margin)
  write-to-string
(&optional control &rest arguments) y-or-n-p yes-or-no-p
"""


@cache
def lambda_lists():
    """Symbol → the text of its lambda list, such as ``"(list &optional n)"``."""
    return {
        sym(name.upper()): f"({' '.join(items.split())})"
        for items, names in re.findall(r"\(([^)]*)\)([^(]*)", TABLE)
        for name in names.split()
    }


@cache
def standard_shape(symbol):
    """The `Shape` of a function of Common Lisp; ``None`` for other symbols."""
    text = lambda_lists().get(symbol)
    return Shape(text) if text is not None else None
