#!/bin/sh
# Writes the address of the page into the file that the extension looks at. The address has a token, so nobody else may read the file.
umask 077
printf '%s\n' "$1" > "$CRAMHY_ADDRESS_FILE.new" && mv "$CRAMHY_ADDRESS_FILE.new" "$CRAMHY_ADDRESS_FILE"
