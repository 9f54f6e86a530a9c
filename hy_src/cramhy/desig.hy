"The macros of CRAM-DESIGNATORS, CRAM-DESIGNATOR-PROPERTIES and CRAM-LANGUAGE-DESIGNATOR-SUPPORT (designators.md).

How the pairs of a designator become the form of its description is a function of the runtime, `designators.syntax`."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)

(setv package "CRAM-DESIGNATORS")

(defn designator-form [form]
  (import cramhy_runtime.languages.commonlisp.faces.designators.syntax [expand])
  (expand form))

(defoperator a [type #* pairs]
  (designator-form (lisp-list (sym "CRAM-DESIGNATORS::A") type #* pairs)))

(defoperator an [type #* pairs]
  (designator-form (lisp-list (sym "CRAM-DESIGNATORS::A") type #* pairs)))

(defoperator all [type #* pairs]
  (designator-form (lisp-list (sym "CRAM-DESIGNATORS::ALL") type #* pairs)))

(defoperator with-desig-props [properties designator #* body]
  (setv variable (gensym "DESIGNATOR"))
  `(let* [[~variable ~designator]
          ~@(lfor property (elements properties)
              [property `(desig-prop-value ~variable (quote ~(sym (+ ":" (symbol-name property)))))])]
     ~@body))

(defoperator with-equate-callback [spec #* body]
  (setv #(designator callback) spec first (gensym "DESIGNATOR") second (gensym "CALLBACK"))
  `(let [[~first ~designator] [~second ~callback]]
     (register-equate-callback ~first ~second)
     (unwind-protect (progn ~@body) (unregister-equate-callback ~first ~second))))

(defoperator "cram-language-designator-support::with-designators" [definitions #* body]
  (setv names (lfor definition (elements definitions) definition.car) form `(progn ~@body))
  (for [#(name type properties) (reversed (elements definitions))]
    (setv form `(let [[~name (%create-designator (quote ~name) ~type ~properties)]] ~form)))
  `(%with-designators (lambda [] ~form) (quote ~(list-from names))))
