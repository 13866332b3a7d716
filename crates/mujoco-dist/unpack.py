"""Check a wheel against its SHA-256 and copy one file out of it.

Arguments: wheel, expected SHA-256, name inside the wheel, destination.
"""

import hashlib
import shutil
import sys
import zipfile

wheel, expected, member, destination = sys.argv[1:]
try:
    with open(wheel, "rb") as stream:
        found = hashlib.sha256(stream.read()).hexdigest()
    if found != expected:
        sys.exit(f"{wheel} has SHA-256 {found}, but {expected} is expected")
    with zipfile.ZipFile(wheel) as archive:
        with archive.open(member) as source, open(destination, "wb") as target:
            shutil.copyfileobj(source, target)
except (OSError, KeyError, zipfile.BadZipFile) as error:
    sys.exit(f"cannot unpack {member} from {wheel}: {error}")
