//! `rig` says what is wrong with a line, a file or a recording, and does not hang.

use std::fs;

use wire::{LONGEST, Message, Reason, encode};

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
        ("count1,count2,torque\n1,2,900\n", "in N m and at most the limit of 6, got 900"),
        (
            "count1,count2,torque\n1,2,3\n",
            "range of angle1 must be at least 0.2 (link 1 hardly moved",
        ),
    ] {
        fs::write(folder.0.join("bad.csv"), csv).unwrap();
        let output = folder.rig(&["identify", "drawn.toml", "bad.csv", "out.toml"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && errors.contains(reason), "{csv}: {errors}");
        assert!(!folder.0.join("out.toml").exists());
    }
}

/// A board with a machine, which has sent all before it is asked.
#[test]
fn a_recording_has_each_tick() {
    let folder = folder("recording");
    let frame = |message: &Message| encode(message, &mut [0; LONGEST]).to_vec();
    let sample = |tick| Message::Sample { tick, counts: [tick as i32, -7], torque: 0.5 };
    let ready = frame(&Message::Stopped(Reason::Asked));
    let ticks: Vec<Vec<u8>> = (0..5).map(|tick| frame(&sample(tick))).collect();
    let (mut lost, mut damaged) = (ticks.clone(), ticks.clone());
    lost.remove(2);
    damaged[3][4] ^= 1;
    let dead = [ticks[..2].concat(), frame(&Message::Stopped(Reason::Failed))].concat();
    // Noise without an end is as bad as silence.
    fs::write(folder.0.join("board.sh"), "cat sent; exec yes").unwrap();
    let record = |sent: Vec<u8>| {
        fs::write(folder.0.join("sent"), [&ready[..], &sent].concat()).unwrap();
        let line = ["record", "drawn.toml", "exec:sh board.sh", "out.csv", "--seconds", "0.01"];
        String::from_utf8(folder.rig(&line).stderr).unwrap()
    };
    for (sent, reason) in [
        (lost.concat(), "a tick was lost before tick 3"),
        (damaged.concat(), "a tick was lost before tick 4"),
        (dead, "the motor is off: no motion of the machine explains what the encoders count"),
        (ticks[..4].concat(), "no message comes from exec:sh board.sh for 2 s"),
    ] {
        let errors = record(sent);
        assert!(errors.contains(reason), "{reason}: {errors}");
        assert!(!folder.0.join("out.csv").exists());
    }
    record(ticks.concat());
    let csv = String::from_utf8(folder.read("out.csv")).unwrap();
    assert_eq!(csv, "count1,count2,torque\n0,-7,0.5\n1,-7,0.5\n2,-7,0.5\n3,-7,0.5\n4,-7,0.5\n");
}
