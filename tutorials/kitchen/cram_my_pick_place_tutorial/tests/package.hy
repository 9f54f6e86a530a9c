(require cramhy *)

(defpackage :cram-my-pick-place-tutorial-tests
  (:nicknames :kitchen-tests)
  (:use :common-lisp :lisp-unit)
  (:import-from :kitchen :init-kitchen :spawn :place-of :things :held :pose :get-ready :go-to :look-at :detect
                :move-bottle :ways-to-take :find-thing :fetch :touches-nothing-p :place-before :there-p
                :*bottle-on-counter* :*before-counter*)
  (:import-from :cram-pr2-projection :with-simulated-robot))
