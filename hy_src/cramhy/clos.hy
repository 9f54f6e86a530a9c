"The macros of CLOS, conditions and structures: they take definitions apart and hand them to the runtime."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)
(import cramhy_runtime.languages.commonlisp.syntax.macros [mentions]
        cramhy_runtime.languages.commonlisp.compiler.compilation_unit [mention-definitions])

(setv package "COMMON-LISP")

(defn options-of [items]
  "A property list of options as pairs (NAME, form)."
  (setv items (list items))
  (when (% (len items) 2)
    (raise (ValueError "an option has no value.")))
  (lfor #(key value) (zip (cut items None None 2) (cut items 1 None 2)) [(symbol-name key) value]))

(defn quoted-list [items]
  `(quote ~(list-from items)))

(setv slot-options #{"INITARG" "INITFORM" "READER" "WRITER" "ACCESSOR" "ALLOCATION" "TYPE" "DOCUMENTATION"})

(defn slot-specification [slot [others-allowed False]]
  "The form that makes the description of a slot of `defclass` and `define-condition`. Other options may be the metaclass's."
  (setv #(name #* rest) (if (listp slot) slot [slot]))
  (setv options (options-of rest))
  (defn every [key] (lfor #(option value) options :if (= option key) value))
  (defn only [key]
    (when (> (len (every key)) 1)
      (program-error "Duplicate slot option :~A for slot ~S." key name))
    (if (every key) (get (every key) 0) None))
  (setv others (lfor #(option _) options :if (not-in option slot-options) option)
        keys (dict (zip (lfor #(option _) options option) (cut rest None None 2))))
  (for [option others]
    (when (not others-allowed)
      (program-error "There is no slot option :~A, which slot ~S has. The options are ~{:~A~^, ~}." option name
                     (list-from (sorted slot-options)))))
  (setv initforms (every "INITFORM"))
  `(%slot-spec (quote ~name)
     :initargs ~(quoted-list (every "INITARG"))
     :initform-source (quote ~(only "INITFORM"))
     :initform ~(if initforms `(lambda [] ~(get initforms 0)) None)
     :readers ~(quoted-list (every "READER"))
     :writers ~(quoted-list (every "WRITER"))
     :accessors ~(quoted-list (every "ACCESSOR"))
     :allocation (quote ~(only "ALLOCATION"))
     :type (quote ~(if (every "TYPE") (only "TYPE") True))
     :documentation ~(only "DOCUMENTATION")
     ~@(if others [(sym ":OTHERS") (quoted-list (sum (lfor option (dict.fromkeys others)
                                                       [(get keys option) (if (> (.count others option) 1) (list-from (every option)) (only option))])
                                                     []))]
           [])))

(defn accessors-of [slot]
  "The names of the functions that a slot of `define-condition` gets."
  (setv options (options-of (if (listp slot) (or slot.cdr []) [])))
  (setv names (lfor #(key name) options :if (and (in key ["READER" "WRITER" "ACCESSOR"]) (is-symbol name)) name))
  [#* names #* (lfor #(key name) options :if (and (= key "ACCESSOR") (is-symbol name)) #("setf" name))])

(defn initargs-form [arguments]
  (when (% (len arguments) 2)
    (program-error "malformed plist, odd number of elements in the :DEFAULT-INITARGS ~S." (list-from arguments)))
  `(list ~@(lfor #(key value) (zip (cut arguments None None 2) (cut arguments 1 None 2))
             `(list (quote ~key) (lambda [] ~value) (quote ~value)))))

(defn function-form [form]
  "What :report and its like take: a string, a name, or a lambda expression."
  (cond
    (or (is form None) (isinstance form str)) form
    (listp form) `(function ~form)
    True `(quote ~form)))

(defn class-options [options [others-allowed False]]
  "Keyword arguments of `define-class` and `define-condition` for class options like (:documentation \"...\")."
  (setv arguments [] others [])
  (for [option options]
    (setv key (symbol-name option.car))
    (.extend arguments
      (match key
        "DOCUMENTATION" [(sym ":DOCUMENTATION") option.cdr.car]
        "DEFAULT-INITARGS" [(sym ":DEFAULT-INITARGS") (initargs-form (elements option.cdr))]
        "METACLASS" [(sym ":METACLASS") `(quote ~option.cdr.car)]
        "REPORT" [(sym ":REPORT") (function-form option.cdr.car)]
        _ (if others-allowed
            (do (.extend others [option.car option.cdr]) [])
            (raise (ValueError (+ "there is no option :" key ".")))))))
  (+ arguments (if others [(sym ":OTHERS") (quoted-list others)] [])))

(defn own-metaclass [options]
  "Whether class options name a metaclass that is not Common Lisp's."
  (any (gfor option options
         (and (listp option) (= (symbol-name option.car) "METACLASS") (!= (symbol-name option.cdr.car) "STANDARD-CLASS")))))

(defoperator defclass [name superclasses slots #* options]
  (setv others (own-metaclass options))
  `(%define-class (quote ~name) (quote ~superclasses)
                  (list ~@(lfor slot (elements slots) (slot-specification slot others)))
                  ~@(class-options options others)))

(defoperator define-condition [name parents slots #* options]
  (for [slot (elements slots)] (mention-definitions (accessors-of slot)))
  `(%define-condition (quote ~name) (quote ~parents)
                      (list ~@(lfor slot (elements slots) (slot-specification slot)))
                      ~@(class-options options)))

;; ----------------------------------------------------------------------------------------------------------- generic functions

(defn method-parts [forms]
  "(qualifiers, lambda list, body) of what follows the name in `defmethod`."
  (setv forms (list forms) qualifiers [])
  (while (and forms (not (listp (get forms 0))) (is-not (get forms 0) None))
    (.append qualifiers (.pop forms 0)))
  (when (not forms)
    (raise (ValueError "the lambda list is missing.")))
  #(qualifiers (get forms 0) (cut forms 1 None)))

(defn plain-parameters [lambda-list]
  "(parameters without specializers, forms of the specializers); after &key other keywords are allowed."
  (setv plain [] specializers [] required True keys False allowed False)
  (for [item (elements lambda-list)]
    (setv marker (and (isinstance item LispSymbol) (.startswith item.name "&")))
    (when marker
      (setv required False)
      (when (= item.name "&KEY") (setv keys True))
      (when (= item.name "&ALLOW-OTHER-KEYS") (setv allowed True))
      (when (and (= item.name "&AUX") keys (not allowed))
        (.append plain (sym "&ALLOW-OTHER-KEYS"))
        (setv allowed True)))
    (cond
      (not required) (.append plain item)
      (listp item) (do
        (.append plain item.car)
        (setv specializer item.cdr.car)
        (.append specializers
          (if (and (listp specializer) (= (symbol-name specializer.car) "EQL"))
              `(list (quote eql) ~specializer.cdr.car)
              `(quote ~specializer))))
      True (do (.append plain item) (.append specializers 't))))
  (when (and keys (not allowed))
    (.append plain (sym "&ALLOW-OTHER-KEYS")))
  #((list-from plain) `(list ~@specializers)))

(defn required-names [plain]
  "The variables of a lambda list up to the first of its keywords."
  (setv names [])
  (for [item (elements plain)]
    (when (and (isinstance item LispSymbol) (.startswith item.name "&")) (break))
    (.append names item))
  names)

(defn safest [declarations]
  "Whether one of the `declare` forms says `(optimize (safety 3))`."
  (setv specifiers (lfor form declarations specifier (elements form.cdr) :if (listp specifier) specifier))
  (any (gfor specifier specifiers :if (is specifier.car (sym "OPTIMIZE")) quality (elements specifier.cdr)
         (or (is quality (sym "SAFETY"))
             (and (listp quality) (is quality.car (sym "SAFETY")) quality.cdr (= quality.cdr.car 3))))))

(defn method-function [name lambda-list body]
  "(function form, whether it takes the next methods)"
  (setv block (if (listp name) name.cdr.car name) #(plain _) (plain-parameters lambda-list))
  (setv #(_ declarations forms) (body-parts body) strict (safest declarations))
  (.append declarations `(declare (ignorable ~@(required-names plain))))  ; their classes choose the method, which is a use
  (setv required (required-names plain) all-required (= (list (elements plain)) required))
  (when (not (mentions (list-from body) #{(sym "CALL-NEXT-METHOD") (sym "NEXT-METHOD-P")}))
    (return #(`(lambda ~plain ~@declarations (block ~block ~@forms)) None)))
  (setv next (gensym "NEXT") rest (gensym "ARGUMENTS"))
  (setv changes (mentions (list-from body) #{(sym "CALL-NEXT-METHOD")} (sym "CALL-NEXT-METHOD")))
  (if (and all-required (= (len (set required)) (len required)))  ; the next method gets what this one got, which nobody changes
      (do
        (setv given (lfor variable required (gensym (symbol-name variable))) changed (if changes [(gensym "CHANGED")] []))
        #(`(lambda [~next ~@changed ~@given]
             (flet [[call-next-method [&rest ~rest] (%next-values ~next ~(if changes (get changed 0) next) ~rest ~@given)]
                    [next-method-p [] (%next-method-exists ~next)]]
               (let [~@(lfor #(variable value) (zip required given) (list-from [variable value]))]
                 ~@declarations
                 (block ~block ~@forms))))
          (if (not changes) :directly (if strict :strictly :changed))))
      (do
        #(`(lambda [~next ~@(elements plain)]
             ~@declarations
             (flet [[call-next-method [&rest ~rest] (apply ~next ~rest)]
                    [next-method-p [] (%next-method-exists ~next)]]
               (block ~block ~@forms)))
          (if (not changes) :same (if strict :strict True))))))

(defoperator defmethod [name #* forms]
  (setv #(qualifiers lambda-list body) (method-parts forms))
  (setv #(_ specializers) (plain-parameters lambda-list) #(function uses-next) (method-function name lambda-list body))
  (setv #(documentation _ _) (body-parts body))
  `(%define-method (quote ~name) ~(quoted-list qualifiers) ~specializers (quote ~lambda-list) ~function
                   :uses-next ~uses-next :documentation ~documentation))

(defn method-option [name option]
  (setv #(qualifiers lambda-list body) (method-parts option.cdr))
  (setv #(_ specializers) (plain-parameters lambda-list) #(function uses-next) (method-function name lambda-list body))
  `(list ~(quoted-list qualifiers) ~specializers (quote ~lambda-list) ~function ~uses-next))

(defn check-generic-lambda-list [lambda-list]
  "Complain of what only methods may have, and of names that no variable can have (ANSI 3.4.2)."
  (setv seen [] required True)
  (for [item (elements lambda-list)]
    (setv name (if (and (listp item) (not required) (is item.cdr None)) item.car item))
    (cond
      (is item (sym "&AUX"))
        (program-error "&AUX is not allowed in a generic function lambda list: ~S" lambda-list)
      (in item [(sym "&OPTIONAL") (sym "&REST") (sym "&KEY") (sym "&ALLOW-OTHER-KEYS")])
        (setv required False)
      (listp name)
        (if (and (not required) (is item.cdr None))
          (.append seen name)
          (program-error "Invalid argument specifier ~S in a generic function lambda list ~S: only methods give defaults and classes."
                         item lambda-list))
      (or (not (is-symbol name)) (isinstance name Keyword) (in name [None True]))
        (program-error "~S cannot be a parameter of a generic function: a parameter is a symbol that is not a constant." name)
      (in name seen)
        (program-error "The variable ~S occurs more than once in the lambda list." name)
      True (.append seen name))))

(defoperator defgeneric [name lambda-list #* options]
  (import cramhy_runtime.languages.commonlisp.evaluation.forms [special-operator-p])
  (setv methods [] arguments [])
  (when (and (is-symbol name) (special-operator-p name))
    (program-error "~S is a special operator, so it cannot name a generic function." name))
  (when (> (len (lfor option options :if (= (symbol-name option.car) "DOCUMENTATION") option)) 1)
    (program-error "Duplicate option :DOCUMENTATION for the generic function ~S." name))
  (check-generic-lambda-list lambda-list)
  (for [option options]
    (match (symbol-name option.car)
      "METHOD" (.append methods (method-option name option))
      "DOCUMENTATION" (.extend arguments [(sym ":DOCUMENTATION") option.cdr.car])
      "METHOD-COMBINATION" (.extend arguments [(sym ":METHOD-COMBINATION") `(quote ~option.cdr)])
      "ARGUMENT-PRECEDENCE-ORDER" (.extend arguments [(sym ":ARGUMENT-PRECEDENCE-ORDER") `(quote ~option.cdr)])
      "GENERIC-FUNCTION-CLASS" (when (!= (symbol-name option.cdr.car) "STANDARD-GENERIC-FUNCTION")
                                 (.extend arguments [(sym ":GENERIC-FUNCTION-CLASS") `(quote ~option.cdr.car)]))
      "METHOD-CLASS" (when (!= (symbol-name option.cdr.car) "STANDARD-METHOD")
                       (.extend arguments [(sym ":METHOD-CLASS") `(quote ~option.cdr.car)]))
      "DECLARE" None
      _ (raise (ValueError (+ "there is no option :" (symbol-name option.car) ".")))))
  `(%define-generic (quote ~name) (quote ~lambda-list) :methods (list ~@methods) ~@arguments))

(defoperator define-method-combination [name #* rest]
  (if (and rest (or (listp (get rest 0)) (is (get rest 0) None)))
      (long-combination name #* rest)
      (do
        (setv options (dict (options-of rest)))
        `(%define-short-combination (quote ~name) :operator (quote ~(.get options "OPERATOR" name))
           :identity-with-one-argument ~(.get options "IDENTITY-WITH-ONE-ARGUMENT")
           :documentation ~(.get options "DOCUMENTATION")))))

(defn group-parts [group]
  "(variable patterns order required) of a method group specifier."
  (setv #(variable #* rest) group patterns [] rest (list rest))
  (while (and rest (not (and (isinstance (get rest 0) LispSymbol) (in (. (get rest 0) name) ["ORDER" "REQUIRED" "DESCRIPTION"]))))
    (.append patterns (.pop rest 0)))
  (setv options (dict (options-of rest)))
  [variable (list-from patterns) (.get options "ORDER") (.get options "REQUIRED")])

(defn combination-options [body]
  "(arguments lambda list, variable of the generic function, documentation, forms) of the long form's body."
  (setv forms (list body) options {"ARGUMENTS" None "GENERIC-FUNCTION" None} documentation None)
  (while (> (len forms) 1)
    (setv head (get forms 0))
    (cond
      (and (listp head) (isinstance head.car LispSymbol) (in head.car.name options))
        (setv (get options head.car.name) (if (= head.car.name "ARGUMENTS") head.cdr head.cdr.car))
      (and (isinstance head str) (is documentation None)) (setv documentation head)
      True (break))
    (.pop forms 0))
  #((get options "ARGUMENTS") (get options "GENERIC-FUNCTION") documentation forms))

(defn long-combination [name lambda-list groups #* body]
  (import cramhy_runtime.languages.commonlisp.syntax.lambda_lists [variables-of])
  (setv parts (lfor group (elements groups) (group-parts group)) options (gensym "OPTIONS"))
  (setv #(arguments generic documentation forms) (combination-options body))
  `(%define-long-combination (quote ~name) (quote ~(list-from (lfor part parts (get part 1))))
     (lambda [~options]
       (destructuring-bind ~lambda-list ~options
         (list ~@(lfor #(_ _ order required) parts `(cons ~order ~required)))))
     (lambda [~(or generic (gensym "GENERIC")) ~options ~@(lfor part parts (get part 0))]
       (destructuring-bind ~lambda-list ~options
         (let [~@(lfor variable (variables-of arguments) [variable `(quote ~variable)])]
           ~@forms)))
     :lambda-list (quote ~arguments) :documentation ~documentation))

(defoperator with-slots [slots instance #* body]
  (setv variable (gensym "INSTANCE"))
  `(let [[~variable ~instance]]
     (symbol-macrolet [~@(lfor slot (elements slots)
                           (if (listp slot)
                               [slot.car `(slot-value ~variable (quote ~slot.cdr.car))]
                               [slot `(slot-value ~variable (quote ~slot))]))]
       ~@body)))

(defoperator with-accessors [accessors instance #* body]
  (setv variable (gensym "INSTANCE"))
  `(let [[~variable ~instance]]
     (symbol-macrolet [~@(lfor #(name accessor) (elements accessors) [name `(~accessor ~variable)])]
       ~@body)))

;; ------------------------------------------------------------------------------------------------------------------ structures

(defn structure-slot [slot]
  (setv #(name #* rest) (if (listp slot) slot [slot]))
  (when (not (is-symbol name))
    (program-error "in DEFSTRUCT, ~S is not a legal slot description: a slot is written NAME or (NAME INITFORM :TYPE TYPE :READ-ONLY T)." slot))
  (setv initform (if rest [(get rest 0)] []) options (dict (options-of (cut rest 1 None))))
  (for [option options]
    (when (not (in option ["TYPE" "READ-ONLY"]))
      (error "~S: unknown slot option :~A of the slot ~S; it may have :type and :read-only." (sym "DEFSTRUCT") option name)))
  `(%structure-slot (quote ~name)
     :initform ~(if initform `(lambda [] ~(get initform 0)) None)
     :type (quote ~(.get options "TYPE" True))
     :read-only ~(if (.get options "READ-ONLY") True None)
     :writable ~(if (= (.get options "READ-ONLY" True) None) True None)))

(defn constructor-form [entry slots included]
  "A constructor of `defstruct`: (name) or name with keywords, or (name lambda-list) by position. `included` names the included type."
  (setv #(name #* rest) (if (listp entry) entry [entry]))
  (if (not rest)
      `(quote ~name)
      (do
        (import cramhy_runtime.languages.commonlisp.objects.structures [boa-lambda-list])
        (setv initforms (dfor slot slots (if (listp slot) slot.car slot) (if (and (listp slot) (listp slot.cdr)) slot.cdr.car None)))
        (setv #(lambda-list variables empty) (boa-lambda-list (get rest 0) initforms included))
        `(list (quote ~name) (quote ~variables) (lambda ~lambda-list (list ~@(elements variables))) (quote ~empty)))))

(defn included-structure [options]
  "The values of the option :include of `defstruct`: the name of the included type and slots with other defaults; [None] without it."
  (for [option options]
    (when (and (listp option) (= (symbol-name option.car) "INCLUDE"))
      (return (elements option.cdr))))
  [None])

(defn structure-functions [name slots options]
  "The names of the functions that `defstruct` defines, as far as its own forms are likely to call them."
  (setv conc (+ name.name "-") makers [(+ "MAKE-" name.name)])
  (for [option options]
    (setv #(key #* values) (if (listp option) option [option]) value (if values (get values 0) None))
    (match (symbol-name key)
      "CONC-NAME" (setv conc (if (is value None) "" (if (is-symbol value) (symbol-name value) (str value))))
      "CONSTRUCTOR" (when (and values (is-symbol value) (is-not value None)) (.append makers (symbol-name value)))))
  (setv readers (lfor slot slots (+ conc (symbol-name (if (listp slot) slot.car slot)))))
  (setv here (. (sym "*PACKAGE*") value))
  (setv [#* named] (lfor text [#* readers #* makers (+ name.name "-P") (+ "COPY-" name.name)] (get (.lookup here text) 0)))
  (setv symbols (lfor each named :if (isinstance each LispSymbol) each))
  [#* symbols #* (lfor each symbols #("setf" each))])

(defn check-structure-options [name keys]
  "Complain of options of `defstruct` that stand there twice. keys: their names."
  (for [key (sfor key keys :if (not-in key ["CONSTRUCTOR" "NAMED"]) key)]
    (when (> (.count keys key) 1)
      (error "~S ~S: there is more than one option :~A." (sym "DEFSTRUCT") name key))))

(defoperator defstruct [head #* slots]
  (setv #(name #* options) (if (listp head) head [head]) slots (list slots))
  (when (not (is-symbol name))
    (error "~S: ~S is not a symbol." (sym "DEFSTRUCT") name))
  (setv documentation (if (and slots (isinstance (get slots 0) str)) (.pop slots 0) None))
  (check-structure-options name (lfor option options (symbol-name (if (listp option) option.car option))))
  (setv arguments [] constructors [] [included #* overrides] (included-structure options))
  (mention-definitions (structure-functions name slots options))
  (for [option options]
    (setv #(key #* values) (if (listp option) option [option]))
    (match (symbol-name key)
      "CONC-NAME" (.extend arguments [(sym ":CONC-NAME") (if values `(quote ~(get values 0)) None)])
      "CONSTRUCTOR" (.append constructors
                      (if values
                          (if (is (get values 0) None) None (constructor-form (list-from values) [#* slots #* overrides] included))
                          `(quote ~(.intern (. name package) (+ "MAKE-" name.name)))))
      "COPIER" (when values (.extend arguments [(sym ":COPIER") `(quote ~(get values 0))]))
      "PREDICATE" (when values (.extend arguments [(sym ":PREDICATE") `(quote ~(get values 0))]))
      "INCLUDE" (.extend arguments [(sym ":INCLUDE") `(quote ~(get values 0))
                                    (sym ":INCLUDE-SLOTS") `(list ~@(map structure-slot (cut values 1 None)))])
      "TYPE" (.extend arguments [(sym ":TYPE") `(quote ~(get values 0))])
      "NAMED" (.extend arguments [(sym ":NAMED") True])
      "INITIAL-OFFSET" (.extend arguments [(sym ":INITIAL-OFFSET") (get values 0)])
      "PRINT-FUNCTION" (when values (.extend arguments [(sym ":PRINT-FUNCTION") (function-form (get values 0))]))
      "PRINT-OBJECT" (when values (.extend arguments [(sym ":PRINT-OBJECT") (function-form (get values 0))]))
      _ (error "unknown DEFSTRUCT option:~%  ~S" option)))
  (when constructors
    (.extend arguments [(sym ":CONSTRUCTORS") `(list ~@(lfor each constructors :if (is-not each None) each))]))
  `(%define-structure (quote ~name) (list ~@(map structure-slot slots)) ~@arguments :documentation ~documentation))
