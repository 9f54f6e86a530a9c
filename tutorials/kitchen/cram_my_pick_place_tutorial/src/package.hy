(require cramhy *)

(defpackage :cram-my-pick-place-tutorial
  (:nicknames :kitchen)
  (:use :common-lisp :cram-prolog :cram-designators :cram-executive
        :cram-pr2-projection :cram-common-failures)
  (:import-from :cram-language :par :with-failure-handling :with-retry-counters :do-retry :retry)
  (:shadowing-import-from :cram-language :fail))
