//! Files of measurements that are not read here: what they are, and how Python makes columns of them.

/// A format that is known by how its files begin.
pub(super) struct Foreign {
    /// What people call it.
    pub(super) name: &'static str,
    /// Two lines of Python; `FILE` stands for the file.
    pub(super) python: [&'static str; 2],
}

/// The line that writes two channels as columns.
const HIT: &str = "numpy.savetxt(\"hit.csv\", numpy.c_[t, force, acc], delimiter=\",\", header=\"time_s,force_n,acceleration_m_s2\", comments=\"\")";

const MAT: Foreign = Foreign {
    name: "a MAT file of MATLAB",
    python: [
        "import numpy, scipy.io; d = scipy.io.loadmat(FILE, squeeze_me=True); t, force, acc = d[\"t\"], d[\"force\"], d[\"acc\"]",
        HIT,
    ],
};
const HDF5: Foreign = Foreign {
    name: "an HDF5 file (MAT files of MATLAB 7.3 are such, too)",
    python: [
        "import numpy, h5py; d = h5py.File(FILE); t, force, acc = (d[name][()].ravel() for name in (\"t\", \"force\", \"acc\"))",
        HIT,
    ],
};
const TDMS: Foreign = Foreign {
    name: "a TDMS file of LabVIEW",
    python: [
        "import numpy; from nptdms import TdmsFile; a, b = TdmsFile.read(FILE).groups()[0].channels()[:2]; t, force, acc = a.time_track(), a[:], b[:]",
        HIT,
    ],
};
const WAV: Foreign = Foreign {
    name: "a WAV file",
    python: [
        "import numpy, scipy.io.wavfile; rate, x = scipy.io.wavfile.read(FILE); t, force, acc = numpy.arange(len(x)) / rate, x[:, 0], x[:, 1]",
        HIT,
    ],
};
const EXCEL: Foreign = Foreign {
    name: "an Excel workbook",
    python: [
        "import pandas; d = pandas.read_excel(FILE)",
        "d.to_csv(\"hit.csv\", index=False)  # its names may stay: orthopanel records hit.csv tells what is read",
    ],
};
const NPY: Foreign = Foreign {
    name: "a NPY or NPZ file of NumPy",
    python: ["import numpy; d = numpy.load(FILE); t, force, acc = (d.values() if hasattr(d, \"files\") else d.T)", HIT],
};

impl Foreign {
    /// The format of a file; `None` for one that is none of these.
    pub(super) fn of(bytes: &[u8]) -> Option<&'static Self> {
        let holds = |name: &[u8]| {
            let start = bytes.get(..LOOKED_AT.min(bytes.len())).unwrap_or_default();
            let end = bytes.get(bytes.len().saturating_sub(LOOKED_AT)..).unwrap_or_default();
            [start, end].iter().any(|part| part.windows(name.len()).any(|window| window == name))
        };
        const SIGNATURE_OF_HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
        // An HDF5 file may begin with a block of the user's, as MATLAB's do.
        let is_hdf5 =
            [0, 512, 1024, 2048].iter().any(|&at| bytes.get(at..).is_some_and(|of| of.starts_with(SIGNATURE_OF_HDF5)));
        if is_hdf5 {
            Some(&HDF5)
        } else if bytes.starts_with(b"MATLAB 5.0 MAT-file") {
            Some(&MAT)
        } else if bytes.starts_with(b"TDSm") || bytes.starts_with(b"TDSh") {
            Some(&TDMS)
        } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WAVE") {
            Some(&WAV)
        } else if bytes.starts_with(b"\x93NUMPY") || (bytes.starts_with(b"PK\x03\x04") && holds(b".npy")) {
            Some(&NPY)
        } else if bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")
            || (bytes.starts_with(b"PK\x03\x04") && holds(b"xl/"))
        {
            Some(&EXCEL)
        } else {
            None
        }
    }

    /// The two lines for a file of this name.
    pub(super) fn python(&self, file: &str) -> [String; 2] {
        self.python.map(|line| line.replace("FILE", &format!("{file:?}")))
    }
}

/// Bytes at either end of an archive in which the names of its members are looked for.
const LOOKED_AT: usize = 1 << 16;
