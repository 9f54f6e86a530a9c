;;;; A courier robot that tidies a kitchen: world model, costmap, task planner, executive and reports.

(defsystem "kitchen-courier"
  :description "Plans of a robot that delivers and tidies up."
  :author "the cramhy tests"
  :version "1.2.0"
  :components ((:file "packages")
               (:module "util"
                :depends-on ("packages")
                :components ((:file "macros")
                             (:file "strings" :depends-on ("macros"))
                             (:file "queue" :depends-on ("macros"))
                             (:file "chance")))
               (:module "world"
                :depends-on ("packages" "util")
                :serial t
                :components ((:file "geometry")
                             (:file "objects")
                             (:file "model")
                             (:file "kitchen")
                             (:file "costmap")))
               (:module "planning"
                :depends-on ("util" "world")
                :components ((:file "patterns")
                             (:file "a-star")
                             (:file "operators" :depends-on ("patterns"))
                             (:file "task-networks" :depends-on ("patterns" "operators"))))
               (:module "execution"
                :depends-on ("planning")
                :components ((:file "conditions")
                             (:file "event-log")
                             (:file "robot" :depends-on ("conditions" "event-log"))
                             (:file "recovery" :depends-on ("conditions" "event-log"))
                             (:file "executor" :depends-on ("robot" "recovery"))))
               (:module "reports"
                :depends-on ("execution")
                :components ((:file "statistics")
                             (:file "report" :depends-on ("statistics"))))
               (:file "main" :depends-on ("reports"))))

(defsystem "kitchen-courier/tests"
  :depends-on ("kitchen-courier" "lisp-unit")
  :components ((:module "tests"
                :serial t
                :components ((:file "package")
                             (:file "util-tests")
                             (:file "world-tests")
                             (:file "planning-tests")
                             (:file "execution-tests"))))
  :perform (test-op (operation component)
             (declare (ignorable operation component))
             (uiop:symbol-call :kitchen-courier-tests :run-all)))
