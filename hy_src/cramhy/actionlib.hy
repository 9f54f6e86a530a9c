"The macros of ACTIONLIB-LISP and ACTIONLIB (roslisp.md 13).

They build messages of field specs as `make-message` does; what they mean stands in `cramhy_runtime.actionlib`. The file is
loaded when those packages are made."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)
(import cramhy.roslisp [build check-path fields-and-values])

(setv package "ACTIONLIB")

(defoperator "actionlib-lisp::make-action-goal-msg" [client #* body]
  (build 'actionlib::build-goal client body))

(defoperator make-action-goal [client #* body]
  (build 'actionlib::build-goal client body))

(defoperator def-exec-callback [name bindings #* body]
  (setv goal (gensym "GOAL") #(documentation declarations forms) (documentation-and-body body))
  `(defun ~name [~goal]
     ~@documentation
     (catch (quote actionlib::exec-callback-tag)
       (roslisp::with-fields ~bindings ~goal ~@declarations ~@forms (actionlib::check-left (quote ~name))))))

(defn message-arguments [arguments]
  "What a macro's arguments hand on for a message: nothing, one form that gives it, or field paths and values."
  (if (< (len arguments) 2)
      arguments
      (do (setv #(paths values) (fields-and-values arguments))
          (for [path (elements paths)] (check-path path))
          [`(quote ~paths) #* values])))

(defoperator succeed-current [#* result]
  `(actionlib::end-goal 3 ~@(message-arguments result)))

(defoperator abort-current [#* result]
  `(actionlib::end-goal 4 ~@(message-arguments result)))

(defoperator preempt-current [#* result]
  `(actionlib::end-goal 2 ~@(message-arguments result)))

(defoperator publish-feedback [#* feedback]
  `(actionlib::tell-feedback ~@(message-arguments feedback)))
