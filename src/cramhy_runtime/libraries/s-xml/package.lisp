;;;; S-XML: XML as programs of ROS and CRAM read it. The names and what they give are those of the library of this name; the code is ours.
;;;; It reads two kinds of valid text that the original refuses: processing instructions inside of elements, and a space in `</name >`.

(defpackage #:s-xml
  (:use #:common-lisp)
  (:export #:start-parse-xml #:print-string-xml
           #:xml-parser-error #:xml-parser-error-message #:xml-parser-error-args #:xml-parser-error-stream
           #:xml-parser-state #:get-entities #:get-seed #:get-new-element-hook #:get-finish-element-hook #:get-text-hook
           #:parse-xml-dom #:parse-xml #:parse-xml-string #:parse-xml-file #:print-xml-dom #:print-xml #:print-xml-string
           #:make-xml-element #:xml-element-p #:xml-element-name #:xml-element-attributes #:xml-element-attribute #:xml-element-children
           #:new-xml-element #:first-xml-element-child
           #:*ignore-namespaces* #:*local-namespace* #:*namespaces* #:*require-existing-symbols* #:*auto-export-symbols*
           #:*auto-create-namespace-packages* #:find-namespace #:register-namespace #:get-prefix #:get-uri #:get-package
           #:resolve-identifier #:extend-namespaces #:print-identifier #:split-identifier)
  (:documentation "XML: a parser that calls hooks, three kinds of trees, a printer, and namespaces as packages."))
