// SPDX-License-Identifier: LGPL-2.1-or-later

// gcc_flow sends a stream like video over UDP. Google Congestion Control, as implemented by pion,
// sets its rate.
//
//	gcc_flow rx PORT        sends transport-wide feedback about received packets every 50 ms
//	gcc_flow tx HOST:PORT   sends 50 frames per second at the target bitrate
//
// It needs Debian's golang-go and golang-github-pion-interceptor-dev (GOPATH=/usr/share/gocode).
package main

import (
	"fmt"
	"log"
	"net"
	"os"
	"time"

	"github.com/pion/interceptor"
	"github.com/pion/interceptor/pkg/cc"
	"github.com/pion/interceptor/pkg/gcc"
	"github.com/pion/interceptor/pkg/twcc"
	"github.com/pion/rtcp"
	"github.com/pion/rtp"
)

const (
	startBitrate    = 1_000_000
	maxBitrate      = 100_000_000
	framesPerSecond = 50
	payloadSize     = 1200
	extensionURI    = "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01"
)

var stream = &interceptor.StreamInfo{
	SSRC:                1,
	RTPHeaderExtensions: []interceptor.RTPHeaderExtension{{URI: extensionURI, ID: 1}},
	RTCPFeedback:        []interceptor.RTCPFeedback{{Type: "transport-cc"}},
}

func build(factories ...interceptor.Factory) (interceptor.Interceptor, error) {
	registry := &interceptor.Registry{}
	for _, factory := range factories {
		registry.Add(factory)
	}
	return registry.Build("")
}

func receive(port string) error {
	address, err := net.ResolveUDPAddr("udp4", "127.0.0.1:"+port)
	if err != nil {
		return err
	}
	socket, err := net.ListenUDP("udp4", address)
	if err != nil {
		return err
	}
	feedback, err := twcc.NewSenderInterceptor(twcc.SendInterval(50 * time.Millisecond))
	if err != nil {
		return err
	}
	chain, err := build(feedback)
	if err != nil {
		return err
	}
	senders := make(chan *net.UDPAddr, 1)
	var sender *net.UDPAddr
	chain.BindRTCPWriter(interceptor.RTCPWriterFunc(func(packets []rtcp.Packet, _ interceptor.Attributes) (int, error) {
		select {
		case sender = <-senders:
		default:
		}
		if sender == nil {
			return 0, nil
		}
		raw, err := rtcp.Marshal(packets)
		if err != nil {
			return 0, err
		}
		return socket.WriteToUDP(raw, sender)
	}))
	reader := chain.BindRemoteStream(stream, interceptor.RTPReaderFunc(func(buffer []byte, attributes interceptor.Attributes) (int, interceptor.Attributes, error) {
		n, from, err := socket.ReadFromUDP(buffer)
		select {
		case senders <- from:
		default:
		}
		return n, attributes, err
	}))
	buffer := make([]byte, 1500)
	for {
		if _, _, err := reader.Read(buffer, interceptor.Attributes{}); err != nil {
			return err
		}
	}
}

func send(to string) error {
	socket, err := net.Dial("udp4", to)
	if err != nil {
		return err
	}
	var estimator cc.BandwidthEstimator
	control, err := cc.NewInterceptor(func() (cc.BandwidthEstimator, error) {
		return gcc.NewSendSideBWE(gcc.SendSideBWEInitialBitrate(startBitrate), gcc.SendSideBWEMaxBitrate(maxBitrate))
	})
	if err != nil {
		return err
	}
	control.OnNewPeerConnection(func(_ string, e cc.BandwidthEstimator) { estimator = e })
	numbers, err := twcc.NewHeaderExtensionInterceptor()
	if err != nil {
		return err
	}
	// A packet gets its number before it waits in the pacer.
	chain, err := build(control, numbers)
	if err != nil {
		return err
	}
	writer := chain.BindLocalStream(stream, interceptor.RTPWriterFunc(func(header *rtp.Header, payload []byte, _ interceptor.Attributes) (int, error) {
		raw, err := (&rtp.Packet{Header: *header, Payload: payload}).Marshal()
		if err != nil {
			return 0, err
		}
		return socket.Write(raw)
	}))
	reports := chain.BindRTCPReader(interceptor.RTCPReaderFunc(func(buffer []byte, attributes interceptor.Attributes) (int, interceptor.Attributes, error) {
		n, err := socket.Read(buffer)
		return n, attributes, err
	}))
	go func() {
		buffer := make([]byte, 1500)
		for {
			if _, _, err := reports.Read(buffer, interceptor.Attributes{}); err != nil {
				log.Print(err)
			}
		}
	}()
	payload := make([]byte, payloadSize)
	header := rtp.Header{Version: 2, PayloadType: 96, SSRC: stream.SSRC}
	left := 0
	for range time.Tick(time.Second / framesPerSecond) {
		left += estimator.GetTargetBitrate() / 8 / framesPerSecond
		for ; left >= payloadSize; left -= payloadSize {
			h := header
			if _, err := writer.Write(&h, payload, nil); err != nil {
				return err
			}
			header.SequenceNumber++
		}
		header.Timestamp += 90000 / framesPerSecond
	}
	return nil
}

func main() {
	programs := map[string]func(string) error{"rx": receive, "tx": send}
	if len(os.Args) != 3 || programs[os.Args[1]] == nil {
		fmt.Fprintln(os.Stderr, "usage: gcc_flow rx PORT | tx HOST:PORT")
		os.Exit(1)
	}
	log.Fatal(programs[os.Args[1]](os.Args[2]))
}
