"The macros of ROSLISP and ROSLISP-UTILITIES (roslisp.md).

Topics of log lines and field paths are not evaluated, so they become constants here; what they mean stands in
`cramhy_runtime.ros`."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *
        cramhy_runtime.lisp_core.condition_types [shown])

(setv package "ROSLISP")

;; ------------------------------------------------------------------------------------------------------- 5: messages

(defn fields-and-values [arguments]
  "(list of the field specs, list of the value forms); a last spec without a value gets nil."
  (setv arguments (if (% (len arguments) 2) [#* arguments None] (list arguments)))
  #((list-from (cut arguments None None 2)) (cut arguments 1 None 2)))

(defn check-path [path]
  "Complain of a field path that is none, where it is written."
  (when (not (or (isinstance path LispSymbol)
                  (and (listp path) (all (gfor name path (isinstance name LispSymbol))))))
    (raise (ValueError (+ "a field is named by a symbol, such as :x, or from the inside out by a list of them, such as (:x :position), "
                          f"but not by {(shown path)}.")))))

(defn build [function head arguments]
  (setv #(paths values) (fields-and-values arguments))
  (for [path (elements paths)] (check-path path))
  `(~function ~head (quote ~paths) ~@values))

(defoperator make-message [type #* arguments]
  (build '%build-message type arguments))

(defoperator make-msg [type #* arguments]
  (build '%build-message type arguments))

(defoperator make-request [type #* arguments]
  (setv designator (if (and (isinstance type LispSymbol)) `(quote ~type) type))
  (build '%build-request designator arguments))

(defoperator make-publisher-msg [publication #* arguments]
  (build '%build-publisher-message publication arguments))

(defoperator publish-msg [publication #* arguments]
  (setv variable (gensym "PUBLICATION"))
  `(let [[~variable ~publication]]
     (publish ~variable ~(build '%build-publisher-message variable arguments))))

(defoperator modify-message-copy [message #* arguments]
  (build '%changed-message message arguments))

(defoperator setf-msg [place #* arguments]
  `(setf ~place ~(build '%changed-message place arguments)))

(defn field-binding [binding message]
  (setv #(variable path) (if (listp binding) binding [binding binding]))
  (check-path path)
  [variable `(%message-field ~message (quote ~path))])

(defoperator with-fields [bindings message #* body]
  (setv variable (gensym "MESSAGE"))
  `(let* [[~variable ~message] ~@(lfor binding (elements bindings) (field-binding binding variable))]
     ~@body))

(defoperator store-message-in [place]
  (setv message (gensym "MESSAGE"))
  `(lambda [~message] (setf ~place ~message)))

;; -------------------------------------------------------------------------------------------------------- 4: logging

(defn log-form [level arguments]
  "A log line: topic, perhaps a condition, format control, arguments. Arguments are evaluated only if it is printed."
  (setv #(topic first #* rest) arguments)
  (when (not (or (isinstance first str) rest))
    (raise (ValueError (+ "what stands between the topic and a literal text is a condition, and here no text follows. "
                          f"A text that is computed is an argument: (ros-... topic \"~a\" {(shown first)})."))))
  (setv condition (if (isinstance first str) True first))
  (setv #(control #* values) (if (isinstance first str) [first #* rest] rest))
  (setv path (if (or (listp topic) (is topic None)) topic (lisp-list topic)))
  `(if (and (%log-enabled ~level (quote ~path)) ~condition)
       (%log-line ~level (quote ~path) ~control ~@values)
       nil))

(defoperator ros-debug [#* arguments] (log-form 1 arguments))
(defoperator ros-info [#* arguments] (log-form 2 arguments))
(defoperator ros-warn [#* arguments] (log-form 4 arguments))
(defoperator ros-error [#* arguments] (log-form 8 arguments))
(defoperator ros-fatal [#* arguments] (log-form 16 arguments))

(defoperator set-debug-levels [#* arguments]
  (setv #(names levels) (fields-and-values arguments))
  `(%set-debug-levels ~@(sum (lfor #(name level) (zip names levels) [`(quote ~name) level]) [])))

;; ----------------------------------------------------------------------------------------------------------- 2: nodes

(defoperator with-ros-node [options #* body]
  (when (or (not (listp options)) (= (% (len (elements options)) 2) 0))
    (raise (ValueError "its first part is a list: the name of the node, then keywords and values in turn.")))
  (setv #(name #* keywords) options spin None rest [])
  (for [#(key value) (zip (cut keywords None None 2) (cut keywords 1 None 2))]
    (if (is key (sym ":SPIN")) (setv spin value) (.extend rest [key value])))
  `(%with-ros-node (list ~name ~@rest) ~spin (lambda [] ~@body)))

(defoperator def-ros-node [name parameters options #* body]
  `(defun ~name []
     (with-ros-node [~(.lower (symbol-name name)) ~@(elements options)]
       (let [~@(lfor parameter (elements parameters) [parameter `(get-param ~(+ "~" (.lower (symbol-name parameter))))])]
         ~@body))))

;; -------------------------------------------------------------------------------------------------------- 7: services

(defn name-and-service [designator]
  (if (listp designator) (list designator) [designator designator]))

(defoperator def-service-callback [service bindings #* body]
  (setv #(name symbol) (name-and-service service) request (gensym "REQUEST") initargs (gensym "INITARGS"))
  `(defun ~name [~request]
     (flet [[make-response [&rest ~initargs] (apply (function %make-response) (quote ~symbol) ~initargs)]]
       (with-fields ~bindings ~request ~@body))))

(defoperator register-service [name type]
  (setv symbol (if (and (listp type) (is type.car (sym "QUOTE"))) type.cdr.car type))
  `(%register-service ~name (quote ~symbol)))

(defoperator def-service-call [designator ros-name #* options]
  (setv #(name symbol) (name-and-service designator) request (gensym "REQUEST"))
  (setv field (if options (get options 1) None))
  `(defun ~name [&rest ~request]
     (%call-named-service ~ros-name (quote ~symbol) ~(if field `(quote ~field) None) ~request)))

;; ------------------------------------------------------------------------------------------------------------ 9: time

(defoperator "roslisp-utils::spin-until" [test increment #* body]
  (setv #(step timeout) (if (listp increment) increment [increment None]))
  `(block nil (%spin-until (lambda [] ~test) ~step ~timeout (lambda [] ~@body))))

(defoperator with-parallel-thread [spec #* body]
  (setv #(function #* name) (if (listp spec) spec [spec]))
  (setv symbol (if (isinstance function LispSymbol) `(quote ~function) function))
  `(%with-parallel-thread ~symbol ~(if name (get name 0) None) (lambda [] ~@body)))

;; ------------------------------------------------------------------------------------- 10: loading message packages

(defn ros-package [name]
  "The ROS package of a name or a type: my_msgs of \"my_msgs/Thing\"."
  (get (.split (.lower (if (isinstance name str) name (symbol-name name))) "/") 0))

(defn load-system-form [name suffix]
  `(asdf::load-system ~(+ (ros-package name) suffix)))

(defn use-system-form [name suffix]
  `(progn ~(load-system-form name suffix)
          (use-package ~(.upper (+ (ros-package name) suffix)))))

(defoperator load-message-types [#* names]
  `(progn ~@(lfor name names (load-system-form name "-msg"))))

(defoperator load-service-types [#* names]
  `(progn ~@(lfor name names (load-system-form name "-srv"))))

(defoperator load-msg [type]
  (use-system-form type "-msg"))

(defoperator load-srv [type]
  (use-system-form type "-srv"))

(defoperator load-if-necessary [#* arguments]
  `(error "load-if-necessary deprecated!"))

;; --------------------------------------------------------------------------------------------- 11: roslisp-utilities

(defoperator "roslisp-utilities::register-ros-init-function" [name [rank 0]]
  `(%register-ros-init-function (quote ~name) (quote ~rank)))
