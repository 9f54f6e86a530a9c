(in-package :cl-user)

(defpackage barista-plans
  (:nicknames :bp)
  (:use #:common-lisp #:cram-prolog #:cram-designators #:cram-process-modules #:cram-executive #:cram-occasions-events #:cut)
  (:import-from #:cpl #:make-fluent #:value #:fl-funcall #:wait-for #:pursue #:par #:seq #:retry #:do-retry
                #:with-retry-counters #:with-failure-handling #:def-cram-function #:def-top-level-cram-function
                #:top-level)
  (:import-from #:barista_msgs-msg #:state #:dimensions #:cups #:owner)
  (:import-from #:barista-knowledge #:find-thing #:thing-pose #:thing-name)
  (:shadow #:pour #:name)
  (:export #:barista-base #:barista-hands #:barista-eyes #:reset-world #:*robot-pose* #:*held* #:*log* #:*cups-fluent* #:*drop-next*
           #:going #:holding #:looking #:drive-to #:look-for #:take #:put #:serving #:fetching #:pouring
           #:serve-guests #:run-demo #:with-barista #:cup->message #:message->list #:tray-message #:cup-held #:robot-at
           #:brew #:start-brewing #:watch-trays #:report))
