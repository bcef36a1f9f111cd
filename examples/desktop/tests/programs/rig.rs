//! `rig` says what is wrong with a line, a file or a recording, and does not hang.

use std::fs;

use crate::Folder;

/// A machine, and one with a parameter that does not exist.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    let drawn = common::text_of("examples/desktop/drawn.toml");
    fs::write(folder.0.join("unknown.toml"), drawn.replace("length2", "lenght2")).unwrap();
    fs::write(folder.0.join("massless.toml"), drawn.clone() + "mass1 = 0.0").unwrap();
    fs::write(folder.0.join("drawn.toml"), drawn).unwrap();
    folder
}

#[test]
fn a_line_that_does_not_work_is_named() {
    let folder = folder("line");
    // By hand: COBS, version 2, message 1, the CRC, and the end.
    let newer = "printf '\\005\\002\\001\\114\\153\\000'; exec cat >/dev/null";
    fs::write(folder.0.join("newer.sh"), newer).unwrap();
    fs::write(folder.0.join("closed.sh"), "exec sleep 1 >&-").unwrap();
    for (port, reason) in [
        ("/dev/nowhere", "cannot open /dev/nowhere"),
        ("exec:nowhere", "cannot start \"nowhere\""),
        ("exec:sh closed.sh", "exec:sh closed.sh has closed the line"),
        (
            "exec:sh newer.sh",
            "the firmware has version 2 of the messages, and this program 1: flash it again",
        ),
    ] {
        let output = folder.rig(&["run", "drawn.toml", port]);
        assert!(!output.status.success() && output.stdout.is_empty());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(reason), "{port}: {errors}");
    }
}

#[test]
fn files_are_checked() {
    let folder = folder("files");
    let unknown = "there is no parameter lenght2; there are: length1, ";
    folder.assert_rejects("rig run unknown.toml exec:true", unknown);
    folder.assert_rejects("rig run massless.toml exec:true", "mass1 must be finite and above 0 kg");
    folder.assert_rejects("rig run nowhere.toml exec:true", "cannot read nowhere.toml");
    for (csv, reason) in [
        ("1,2,3\n", "bad.csv must begin with the line count1,count2,torque"),
        ("count1,count2,torque\n1,2,3\n1,2\n", "bad.csv:3: not three numbers: 1,2"),
        ("count1,count2,torque\n1,2,3\n", "shake it more: this recording fits no machine"),
    ] {
        fs::write(folder.0.join("bad.csv"), csv).unwrap();
        let output = folder.rig(&["identify", "drawn.toml", "bad.csv", "out.toml"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && errors.contains(reason), "{csv}: {errors}");
        assert!(!folder.0.join("out.toml").exists());
    }
}
